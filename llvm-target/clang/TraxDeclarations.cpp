//===- TraxDeclarations.cpp - corrections of clang's declarations --------===//
//
// A plugin that is linked in. It sees declarations before the code generator does.
//
// - Clang drops `__builtin_` from the name of a builtin that becomes a library call. `trax_rsqrt` and the like are
// names
//   that a program may use. So each builtin that a file mentions gets its full name back as an assembler label.
// - Clang accepts ifunc, and builtins that take _Float16, for every ELF target. Here they are errors.
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

// Name and label.
const char *const Labels[][2] = {
#define BUILTIN(ID, NAME, TYPE, ATTRIBUTES) {"__builtin_trax_" #NAME, "__builtin_trax_" #NAME},
#include "TraxBuiltins.def"
    {"__builtin_debugtrap", "llvm.debugtrap"},
};

class Declarations final : public ASTConsumer {
public:
  void Initialize(ASTContext &C) override { Context = &C; }

  // Called when bodies are complete and their callees are declared.
  bool HandleTopLevelDecl(DeclGroupRef Group) override {
    label();
    for (const Decl *Declared : Group)
      refuseIFunc(Declared);
    return true;
  }
  void HandleInlineFunctionDefinition(FunctionDecl *) override { label(); }
  void HandleTranslationUnit(ASTContext &) override {
    label();
    refuseHalf();
  }

private:
  ASTContext *Context = nullptr;

  void refuseIFunc(const Decl *Declared) {
    if (const auto *Attribute = Declared->getAttr<IFuncAttr>())
      Context->getDiagnostics().Report(
          Attribute->getLocation(),
          Context->getDiagnostics().getCustomDiagID(DiagnosticsEngine::Error,
                                                    "ifunc is not supported: nothing resolves functions at start"))
          << Attribute->getRange();
    if (isa<NamespaceDecl, LinkageSpecDecl>(Declared)) // extern "C" { ... }
      for (const Decl *Inner : cast<DeclContext>(Declared)->decls())
        refuseIFunc(Inner);
  }

  /// Clang refuses _Float16 where it is written, but not the builtins that take it. A builtin is declared at its first
  /// use.
  void refuseHalf() {
    DiagnosticsEngine &Diags = Context->getDiagnostics();
    const unsigned ID =
        Diags.getCustomDiagID(DiagnosticsEngine::Error, "'%0' is not supported on this target: it takes '_Float16'");
    for (const Decl *Declared : Context->getTranslationUnitDecl()->noload_decls())
      if (const auto *Function = dyn_cast<FunctionDecl>(Declared);
          Function && Function->isImplicit() && Function->getBuiltinID())
        if (Function->getReturnType()->isHalfType() || Function->getReturnType()->isFloat16Type() ||
            llvm::any_of(Function->parameters(), [](const ParmVarDecl *P) {
              return P->getType()->isHalfType() || P->getType()->isFloat16Type();
            }))
          Diags.Report(Function->getLocation(), ID) << Function->getName();
  }

  void label() {
    for (const auto &[Name, Label] : Labels) {
      auto Identifier = Context->Idents.find(Name);
      if (Identifier == Context->Idents.end())
        continue;
      for (NamedDecl *Declared : Context->getTranslationUnitDecl()->lookup(Identifier->getValue())) {
        auto *Function = dyn_cast<FunctionDecl>(Declared);
        if (!Function || !Function->getBuiltinID())
          continue;
        for (FunctionDecl *Redeclared : Function->redecls())
          if (!Redeclared->hasAttr<AsmLabelAttr>())
            Redeclared->addAttr(AsmLabelAttr::CreateImplicit(*Context, Label, /*IsLiteralLabel=*/true));
      }
    }
  }
};

class DeclarationsPlugin final : public PluginASTAction {
  std::unique_ptr<ASTConsumer> CreateASTConsumer(CompilerInstance &CI, llvm::StringRef) override {
    if (trax::isTraxTriple(CI.getTarget().getTriple()))
      return std::make_unique<Declarations>();
    return std::make_unique<ASTConsumer>();
  }
  bool ParseArgs(const CompilerInstance &, const std::vector<std::string> &) override { return true; }
  ActionType getActionType() override { return AddBeforeMainAction; }
};

const FrontendPluginRegistry::Add<DeclarationsPlugin> Registration("trax-declarations",
                                                                   "names of builtins, and unsupported declarations");

} // namespace
