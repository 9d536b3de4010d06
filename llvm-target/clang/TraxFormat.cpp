//===- TraxFormat.cpp - -Wformat for conversions that our printf lacks ----===//
//
// Clang's -Wformat accepts positional arguments and %m, which other libraries have, and cannot know that iprintf and
// its relatives format no doubles. Each of these stops a program (docs/runtime.md). A plugin that is linked in gives
// them the warning of any other invalid conversion.
//
//===----------------------------------------------------------------------===//

#include "TraxTargetInfo.h"
#include "clang/AST/ASTConsumer.h"
#include "clang/AST/ASTContext.h"
#include "clang/AST/Attr.h"
#include "clang/AST/Decl.h"
#include "clang/AST/Expr.h"
#include "clang/AST/FormatString.h"
#include "clang/AST/RecursiveASTVisitor.h"
#include "clang/Basic/DiagnosticSema.h"
#include "clang/Frontend/CompilerInstance.h"
#include "clang/Frontend/FrontendPluginRegistry.h"

using namespace clang;
using analyze_printf::PrintfSpecifier;

namespace {

/// Reports the conversions of one format.
class FormatCheck final : public analyze_format_string::FormatStringHandler {
  const ASTContext &Context;
  const StringLiteral &Format;
  const bool HasDoubles;

public:
  FormatCheck(const ASTContext &Context, const StringLiteral &Format, bool HasDoubles)
      : Context(Context), Format(Format), HasDoubles(HasDoubles) {}

  bool HandlePrintfSpecifier(const PrintfSpecifier &Conversion, const char *Start, unsigned Length,
                             const TargetInfo &Target) override {
    const auto &Specifier = Conversion.getConversionSpecifier();
    const bool IsPositional = Conversion.usesPositionalArg() || Conversion.getFieldWidth().usesPositionalArg() ||
                              Conversion.getPrecision().usesPositionalArg();
    if (!IsPositional && Specifier.getKind() != analyze_format_string::ConversionSpecifier::PrintErrno &&
        (HasDoubles || !Specifier.isDoubleArg()))
      return true;
    const auto Place = Format.getLocationOfByte(Start - Format.getString().data(), Context.getSourceManager(),
                                                Context.getLangOpts(), Target);
    Context.getDiagnostics().Report(Place, diag::warn_format_invalid_conversion)
        << (IsPositional ? llvm::StringRef(Start, Length).drop_front() : Specifier.getCharacters());
    return true;
  }
};

class Calls final : public RecursiveASTVisitor<Calls> {
  const ASTContext &Context;

  void check(const Expr *Format, bool HasDoubles) const {
    Format = Format->IgnoreParenImpCasts();
    if (const auto *Choice = dyn_cast<ConditionalOperator>(Format)) {
      check(Choice->getTrueExpr(), HasDoubles);
      check(Choice->getFalseExpr(), HasDoubles);
    }
    const auto *Literal = dyn_cast<StringLiteral>(Format);
    if (!Literal || !Literal->isOrdinary())
      return;
    FormatCheck Check(Context, *Literal, HasDoubles);
    const llvm::StringRef Text = Literal->getString();
    analyze_format_string::ParsePrintfString(Check, Text.begin(), Text.end(), Context.getLangOpts(),
                                             Context.getTargetInfo(), /*isFreeBSDKPrintf=*/false);
  }

public:
  explicit Calls(const ASTContext &Context) : Context(Context) {}

  bool VisitCallExpr(CallExpr *Call) {
    const FunctionDecl *Callee = Call->getDirectCallee();
    if (!Callee || !Callee->getIdentifier())
      return true;
    const bool HasDoubles = !llvm::is_contained({"iprintf", "fiprintf", "siprintf", "sniprintf"}, Callee->getName());
    for (const auto *Attribute : Callee->specific_attrs<FormatAttr>()) {
      // The attribute of a member function counts the object as the first argument; the call does not.
      const auto *Member = dyn_cast<CXXMethodDecl>(Callee);
      const unsigned First = Member && Member->isInstance() ? 2 : 1;
      const unsigned Index = Attribute->getFormatIdx();
      if (Attribute->getType()->isStr("printf") && Index >= First && Index - First < Call->getNumArgs())
        check(Call->getArg(Index - First), HasDoubles);
    }
    return true;
  }
};

class Consumer final : public ASTConsumer {
  ASTContext *Context = nullptr;

  void Initialize(ASTContext &Given) override { Context = &Given; }
  bool HandleTopLevelDecl(DeclGroupRef Group) override {
    for (Decl *Declared : Group)
      Calls(*Context).TraverseDecl(Declared);
    return true;
  }
};

class FormatPlugin final : public PluginASTAction {
  std::unique_ptr<ASTConsumer> CreateASTConsumer(CompilerInstance &CI, llvm::StringRef) override {
    if (!trax::isTraxTriple(CI.getTarget().getTriple()))
      return std::make_unique<ASTConsumer>();
    return std::make_unique<Consumer>();
  }
  bool ParseArgs(const CompilerInstance &, const std::vector<std::string> &) override { return true; }
  ActionType getActionType() override { return AddBeforeMainAction; }
};

const FrontendPluginRegistry::Add<FormatPlugin> FormatRegistered("trax-format",
                                                                 "what the library's printf does not know");

} // namespace
