//===- TraxTargetTransformInfo.cpp - Costs, for the IR optimizer ---------===//
#include "TraxTargetTransformInfo.h"
#include "TraxBuiltins.h"
#include "llvm/IR/Function.h"
#include "llvm/Support/MathExtras.h"

using namespace llvm;

using TTI = TargetTransformInfo;

bool TraxTTIImpl::isLoweredToCall(const Function *F) const {
  if (F->hasName() && TraxBuiltin::find(F->getName()))
    return false;
  return BaseT::isLoweredToCall(F);
}

// A taken branch costs one cycle and the instruction cache holds 1,024 instructions, shared by all: unrolling pays
// where it turns a small array's indices into constants, not to save the branch.
void TraxTTIImpl::getUnrollingPreferences(Loop *L, ScalarEvolution &SE, TTI::UnrollingPreferences &UP,
                                          OptimizationRemarkEmitter *ORE) {
  BaseT::getUnrollingPreferences(L, SE, UP, ORE);
  UP.Threshold = 120;
  UP.PartialThreshold = 0;
  UP.OptSizeThreshold = 0;
  UP.PartialOptSizeThreshold = 0;
  UP.Partial = false;
  UP.Runtime = false;
  UP.UpperBound = false;
}

void TraxTTIImpl::getPeelingPreferences(Loop *L, ScalarEvolution &SE, TTI::PeelingPreferences &PP) {
  BaseT::getPeelingPreferences(L, SE, PP);
}

InstructionCost TraxTTIImpl::getIntImmCost(const APInt &Imm, Type *Ty, TTI::TargetCostKind) {
  if (Imm == 0)
    return TTI::TCC_Free;
  unsigned Instructions = 0;
  APInt Value = Imm.sext(alignTo(std::max(Imm.getBitWidth(), Ty->getIntegerBitWidth()), 32));
  for (unsigned Bit = 0; Bit < Value.getBitWidth(); Bit += 32) {
    int64_t Word = Value.extractBits(32, Bit).getSExtValue();
    Instructions += Word == 0 ? 0 : isInt<16>(Word) || (Word & 0xFFFF) == 0 ? 1 : 2;
  }
  return std::max(1u, Instructions) * TTI::TCC_Basic;
}

InstructionCost TraxTTIImpl::getIntImmCostInst(unsigned Opcode, unsigned Idx, const APInt &Imm, Type *Ty,
                                               TTI::TargetCostKind CostKind, Instruction *) {
  bool Fits = Imm.getSignificantBits() <= 16;
  bool Encoded = false;
  switch (Opcode) {
  case Instruction::GetElementPtr: // split and folded by other passes
    return TTI::TCC_Free;
  case Instruction::And:
    Encoded = Fits || Imm.isMask();
    break;
  case Instruction::Add:
  case Instruction::Or:
  case Instruction::Xor:
  case Instruction::ICmp:
    Encoded = Fits;
    break;
  case Instruction::Sub:
    Encoded = Idx == 1 && (-Imm).getSignificantBits() <= 16;
    break;
  case Instruction::Shl:
  case Instruction::LShr:
  case Instruction::AShr:
    Encoded = Idx == 1;
    break;
  case Instruction::Mul: // shifts and adds, perhaps
    Encoded = Idx == 1 && (Imm.isPowerOf2() || Imm.isNegatedPowerOf2());
    break;
  case Instruction::Store:
    break;
  default: // a constant elsewhere is not worth hoisting
    return TTI::TCC_Free;
  }
  return Encoded && Idx <= 1 ? InstructionCost(TTI::TCC_Free) : getIntImmCost(Imm, Ty, CostKind);
}

InstructionCost TraxTTIImpl::getIntImmCostIntrin(Intrinsic::ID, unsigned, const APInt &, Type *, TTI::TargetCostKind) {
  return TTI::TCC_Free;
}
