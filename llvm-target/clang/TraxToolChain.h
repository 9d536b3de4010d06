//===- TraxToolChain.h - how the driver compiles and links for Trax ------===//
//
// Clang's driver picks its generic ELF tool chain for an architecture it does not know. These functions give that tool
// chain the machine's defaults, refuse what the machine cannot do, and make its link job ours.
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_CLANG_TRAXTOOLCHAIN_H
#define TRAX_CLANG_TRAXTOOLCHAIN_H

#include "clang/Driver/InputInfo.h"
#include "clang/Driver/Job.h"
#include "clang/Driver/Tool.h"
#include "llvm/ADT/SmallVector.h"
#include "llvm/ADT/StringRef.h"
#include "llvm/Support/StringSaver.h"
#include <memory>
#include <string>

namespace trax {

/// -mstack=local|global and -mstack-size=BYTES, which clang's table of options does not have.
class StackOptions {
public:
  /// Removes them from the arguments; the last of each counts.
  explicit StackOptions(llvm::SmallVectorImpl<const char *> &Args);

  /// Reports what is wrong with them, for the target of the compilation.
  void check(const clang::driver::Compilation &C, bool ForTrax);

  bool isGlobal() const { return Place == "global"; }
  /// Of each thread's stack in global memory: a multiple of 64.
  unsigned bytes() const { return Bytes; }

private:
  llvm::StringRef Place, Size; // as given; empty if not
  unsigned Bytes = 64 * 1024;
};

/// Puts the machine's defaults behind the program's name, so that the user's own options come later and win.
/// RuntimeDir holds crt0.o, libc.a and include/.
void insertDefaults(llvm::SmallVectorImpl<const char *> &Args, const StackOptions &Stack, llvm::StringRef RuntimeDir,
                    llvm::StringSaver &Strings);

/// Reports options that clang accepts for any target and this machine cannot obey.
void checkOptions(const clang::driver::Compilation &C);

/// trax-ld, as the driver sees its tools.
class Linker final : public clang::driver::Tool {
public:
  /// RuntimeDir holds crt0.o and libc.a. The linker must outlive the compilation's execution.
  Linker(const clang::driver::ToolChain &TC, const StackOptions &Stack, std::string RuntimeDir)
      : Tool("trax::Linker", "linker", TC), Stack(Stack), RuntimeDir(std::move(RuntimeDir)) {}

  /// Replaces the generic tool chain's link jobs, which call gcc.
  void replaceJobs(clang::driver::Compilation &C) const;

  bool hasIntegratedCPP() const override { return false; }
  bool isLinkJob() const override { return true; }
  void ConstructJob(clang::driver::Compilation &C, const clang::driver::JobAction &Link,
                    const clang::driver::InputInfo &Output, const clang::driver::InputInfoList &Inputs,
                    const llvm::opt::ArgList &Args, const char *LinkingOutput) const override;

private:
  const StackOptions Stack;
  const std::string RuntimeDir;

  std::unique_ptr<clang::driver::Command> makeCommand(const clang::driver::Compilation &C,
                                                      const clang::driver::Action &Link,
                                                      const clang::driver::InputInfo &Output,
                                                      const clang::driver::InputInfoList &Inputs) const;
};

} // namespace trax

#endif
