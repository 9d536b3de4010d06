//===- TraxMCExpr.cpp - %hi(x), %lo(x) and %abs(x) -----------------------===//
#include "TraxMCExpr.h"
#include "llvm/ADT/StringSwitch.h"
#include "llvm/MC/MCAssembler.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCStreamer.h"
#include "llvm/MC/MCValue.h"
#include "llvm/Support/MathExtras.h"

using namespace llvm;

const TraxMCExpr *TraxMCExpr::create(const MCExpr *Expr, Specifier Spec, MCContext &Ctx) {
  return new (Ctx) TraxMCExpr(Expr, Spec);
}

std::optional<TraxMCExpr::Specifier> TraxMCExpr::parseSpecifier(StringRef Name) {
  return StringSwitch<std::optional<Specifier>>(Name)
      .Case("hi", S_HI)
      .Case("lo", S_LO)
      .Case("abs", S_ABS)
      .Default(std::nullopt);
}

StringRef TraxMCExpr::getSpecifierName(Specifier Spec) {
  switch (Spec) {
  case S_HI:
    return "hi";
  case S_LO:
    return "lo";
  case S_ABS:
    return "abs";
  }
  llvm_unreachable("no such specifier");
}

int64_t TraxMCExpr::apply(int64_t Value) const {
  switch (Spec) {
  case S_HI: // rounded, since the machine sign-extends the lower half
    return ((Value + 0x8000) >> 16) & 0xFFFF;
  case S_LO:
    return SignExtend64<16>(Value);
  case S_ABS:
    return SignExtend64<32>(Value);
  }
  llvm_unreachable("no such specifier");
}

void TraxMCExpr::printImpl(raw_ostream &OS, const MCAsmInfo *MAI) const {
  OS << '%' << getSpecifierName(Spec) << '(';
  Expr->print(OS, MAI);
  OS << ')';
}

bool TraxMCExpr::evaluateAsRelocatableImpl(MCValue &Res, const MCAssembler *Asm, const MCFixup *Fixup) const {
  if (!Expr->evaluateAsRelocatable(Res, Asm, Fixup))
    return false;
  if (Res.isAbsolute()) {
    // With a fixup, the back end applies the operator; a plain evaluation must give the operator's value.
    if (!Fixup)
      Res = MCValue::get(apply(Res.getConstant()));
    return true;
  }
  Res = MCValue::get(Res.getSymA(), Res.getSymB(), Res.getConstant(), Spec + 1);
  return Res.getSymB() == nullptr || Fixup != nullptr;
}

void TraxMCExpr::visitUsedExpr(MCStreamer &Streamer) const {
  Streamer.visitUsedExpr(*Expr);
}
