//===- TraxMCExpr.h - %hi(x), %lo(x) and %abs(x) -------------------------===//
#ifndef TRAX_MCTARGETDESC_TRAXMCEXPR_H
#define TRAX_MCTARGETDESC_TRAXMCEXPR_H

#include "llvm/MC/MCExpr.h"
#include <optional>

namespace llvm {

class TraxMCExpr : public MCTargetExpr {
public:
  enum Specifier { S_HI, S_LO, S_ABS };

private:
  const MCExpr *Expr;
  Specifier Spec;

  TraxMCExpr(const MCExpr *Expr, Specifier Spec) : Expr(Expr), Spec(Spec) {}

public:
  static const TraxMCExpr *create(const MCExpr *Expr, Specifier Spec, MCContext &Ctx);
  static std::optional<Specifier> parseSpecifier(StringRef Name);
  static StringRef getSpecifierName(Specifier Spec);

  Specifier getSpecifier() const { return Spec; }
  const MCExpr *getSubExpr() const { return Expr; }

  /// The 16 bits that the operator selects of \p Value (%abs: all of it).
  int64_t apply(int64_t Value) const;

  void printImpl(raw_ostream &OS, const MCAsmInfo *MAI) const override;
  bool evaluateAsRelocatableImpl(MCValue &Res, const MCAssembler *Asm, const MCFixup *Fixup) const override;
  void visitUsedExpr(MCStreamer &Streamer) const override;
  MCFragment *findAssociatedFragment() const override { return Expr->findAssociatedFragment(); }
  /// A thread-local symbol's address is absolute: nothing marks it but its own section.
  void fixELFSymbolsInTLSFixups(MCAssembler &) const override {}

  static bool classof(const MCExpr *E) { return E->getKind() == MCExpr::Target; }
};

} // namespace llvm

#endif
