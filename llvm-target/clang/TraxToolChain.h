//===- TraxToolChain.h - how clang's driver compiles and links for Trax --===//
#ifndef TRAX_CLANG_TRAXTOOLCHAIN_H
#define TRAX_CLANG_TRAXTOOLCHAIN_H

#include "clang/Driver/Tool.h"
#include "clang/Driver/ToolChain.h"
#include "llvm/Option/ArgList.h"
#include <memory>
#include <string>

namespace trax {

/// Makes the driver find the tool chain for the target's triples by itself. RuntimeDir holds crt0.o, libc.a and
/// include/; --sysroot names another such directory.
void addToolChains(clang::driver::Driver &D, const std::string &RuntimeDir);

/// The machine's defaults, as overrides of what clang asks its tool chains.
class ToolChain final : public clang::driver::ToolChain {
public:
  ToolChain(const clang::driver::Driver &D, const llvm::Triple &Triple, std::string RuntimeDir);

  bool isPICDefault() const override { return false; } // addresses are absolute
  bool isPIEDefault(const llvm::opt::ArgList &) const override { return false; }
  bool isPICDefaultForced() const override { return false; }
  bool IsMathErrnoDefault() const override { return false; }
  bool HasNativeLLVMSupport() const override { return true; } // -flto is refused below, in one message
  unsigned GetDefaultDwarfVersion() const override { return 4; }
  CXXStdlibType GetCXXStdlibType(const llvm::opt::ArgList &) const override { return CST_Libcxx; }

  std::string computeSysRoot() const override;
  std::string getCompilerRTPath() const override { return computeSysRoot(); }
  void AddClangSystemIncludeArgs(const llvm::opt::ArgList &Args, llvm::opt::ArgStringList &CC1Args) const override;
  void AddClangCXXStdlibIncludeArgs(const llvm::opt::ArgList &Args, llvm::opt::ArgStringList &CC1Args) const override;
  void addClangTargetOptions(const llvm::opt::ArgList &Args, llvm::opt::ArgStringList &CC1Args,
                             clang::driver::Action::OffloadKind) const override;

  /// Changes nothing: reports options that the machine cannot obey.
  llvm::opt::DerivedArgList *TranslateArgs(const llvm::opt::DerivedArgList &Args, llvm::StringRef BoundArch,
                                           clang::driver::Action::OffloadKind) const override;

  clang::driver::Tool *SelectTool(const clang::driver::JobAction &JA) const override;

protected:
  clang::driver::Tool *buildLinker() const override;
  /// --emit-static-lib is refused, but only after the driver has asked for its tool: any tool will do.
  clang::driver::Tool *buildStaticLibTool() const override { return buildLinker(); }

private:
  const std::string RuntimeDir;
  mutable std::unique_ptr<clang::driver::Tool> Compiler;
};

} // namespace trax

#endif
