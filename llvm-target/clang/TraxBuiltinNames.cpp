//===- TraxBuiltinNames.cpp - keep the builtins' names in the IR ---------===//
//
// Clang drops `__builtin_` from the name of a builtin that becomes a library call. `trax_rsqrt` and its like are names
// that a program may use, so each builtin that a file mentions gets its full name back as an assembler label before
// code is generated.
//
//===----------------------------------------------------------------------===//

#include "TraxTargetInfo.h"
#include "clang/AST/ASTConsumer.h"
#include "clang/AST/ASTContext.h"
#include "clang/AST/Attr.h"
#include "clang/AST/Decl.h"
#include "clang/Basic/TargetInfo.h"
#include "clang/Frontend/CompilerInstance.h"
#include "clang/Frontend/FrontendPluginRegistry.h"

using namespace clang;

namespace {

const char *const Names[] = {
#define BUILTIN(ID, NAME, TYPE, ATTRIBUTES) "__builtin_trax_" #NAME,
#include "TraxBuiltins.def"
};

class LabelBuiltins final : public ASTConsumer {
public:
  void Initialize(ASTContext &C) override { Context = &C; }

  // A body is complete when it arrives here, and what it calls declared.
  bool HandleTopLevelDecl(DeclGroupRef) override {
    label();
    return true;
  }
  void HandleInlineFunctionDefinition(FunctionDecl *) override { label(); }
  void HandleTranslationUnit(ASTContext &) override { label(); }

private:
  ASTContext *Context = nullptr;

  void label() {
    for (const char *Name : Names) {
      auto Identifier = Context->Idents.find(Name);
      if (Identifier == Context->Idents.end())
        continue;
      for (NamedDecl *Declared : Context->getTranslationUnitDecl()->lookup(Identifier->getValue())) {
        auto *Function = dyn_cast<FunctionDecl>(Declared);
        if (!Function || !Function->getBuiltinID())
          continue;
        for (FunctionDecl *Redeclared : Function->redecls())
          if (!Redeclared->hasAttr<AsmLabelAttr>())
            Redeclared->addAttr(AsmLabelAttr::CreateImplicit(*Context, Name, /*IsLiteralLabel=*/true));
      }
    }
  }
};

class LabelBuiltinsAction final : public PluginASTAction {
  std::unique_ptr<ASTConsumer> CreateASTConsumer(CompilerInstance &CI, llvm::StringRef) override {
    if (trax::isTraxTriple(CI.getTarget().getTriple()))
      return std::make_unique<LabelBuiltins>();
    return std::make_unique<ASTConsumer>();
  }
  bool ParseArgs(const CompilerInstance &, const std::vector<std::string> &) override { return true; }
  ActionType getActionType() override { return AddBeforeMainAction; }
};

const FrontendPluginRegistry::Add<LabelBuiltinsAction> Registration("trax-builtin-names",
                                                                    "keep the names of Trax builtins");

} // namespace
