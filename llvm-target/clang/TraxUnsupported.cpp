//===- TraxUnsupported.cpp - what clang would take without a word --------===//
//
// Clang accepts some attributes for any ELF target, although something outside the compiler has to do its part. What
// here nobody would do is refused where it stands. A plugin that is linked in gets to see declarations before the code
// generator.
//
//===----------------------------------------------------------------------===//

#include "TraxTargetInfo.h"
#include "clang/AST/ASTConsumer.h"
#include "clang/AST/ASTContext.h"
#include "clang/AST/Attr.h"
#include "clang/AST/Decl.h"
#include "clang/Frontend/CompilerInstance.h"
#include "clang/Frontend/FrontendPluginRegistry.h"

using namespace clang;

namespace {

class UnsupportedAttributes final : public ASTConsumer {
  DiagnosticsEngine &Diags;
  const unsigned NoIFunc;

public:
  explicit UnsupportedAttributes(DiagnosticsEngine &Diags)
      : Diags(Diags), NoIFunc(Diags.getCustomDiagID(DiagnosticsEngine::Error,
                                                    "ifunc is not supported: nothing resolves functions at start")) {}

  bool HandleTopLevelDecl(DeclGroupRef Group) override {
    for (const Decl *Declared : Group)
      if (const auto *Attribute = Declared->getAttr<IFuncAttr>())
        Diags.Report(Attribute->getLocation(), NoIFunc) << Attribute->getRange();
    return true;
  }
};

class UnsupportedPlugin final : public PluginASTAction {
  std::unique_ptr<ASTConsumer> CreateASTConsumer(CompilerInstance &CI, llvm::StringRef) override {
    if (!trax::isTraxTriple(CI.getTarget().getTriple()))
      return std::make_unique<ASTConsumer>();
    return std::make_unique<UnsupportedAttributes>(CI.getDiagnostics());
  }
  bool ParseArgs(const CompilerInstance &, const std::vector<std::string> &) override { return true; }
  ActionType getActionType() override { return AddBeforeMainAction; }
};

const FrontendPluginRegistry::Add<UnsupportedPlugin>
    UnsupportedRegistered("trax-unsupported", "refuses what the machine has no support for");

} // namespace
