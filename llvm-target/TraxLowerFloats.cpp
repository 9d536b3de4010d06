//===- TraxLowerFloats.cpp - Strict and canonical floats as plain ones ---===//
//
// The machine rounds to nearest and has no flags, so a constrained operation computes what the plain one does, and
// instruction selection needs to know the plain ones only. This pass writes out those that LLVM cannot expand.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "llvm/IR/DiagnosticInfo.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/IR/Module.h"
#include "llvm/InitializePasses.h"
#include "llvm/Pass.h"

using namespace llvm;

#define DEBUG_TYPE "trax-lower-floats"

static Value *createPlain(IRBuilder<> &Builder, ConstrainedFPIntrinsic &Call) {
  SmallVector<Value *, 3> Operands(Call.arg_begin(), Call.arg_begin() + Call.getNonMetadataArgCount());
  Intrinsic::ID Plain;
  unsigned Opcode = 0;
  switch (Call.getIntrinsicID()) {
#define DAG_INSTRUCTION(NAME, COUNT, ROUNDS, INTRINSIC, NODE)                                                          \
  case Intrinsic::INTRINSIC:                                                                                           \
    Opcode = Instruction::NAME;                                                                                        \
    break;
#define CMP_INSTRUCTION(NAME, COUNT, ROUNDS, INTRINSIC, NODE)                                                          \
  case Intrinsic::INTRINSIC:                                                                                           \
    return Builder.CreateFCmp(cast<ConstrainedFPCmpIntrinsic>(Call).getPredicate(), Operands[0], Operands[1]);
#define FUNCTION(NAME, COUNT, ROUNDS, INTRINSIC)                                                                       \
  case Intrinsic::INTRINSIC:                                                                                           \
    Plain = Intrinsic::NAME;                                                                                           \
    break;
#define DAG_FUNCTION(NAME, COUNT, ROUNDS, INTRINSIC, NODE) FUNCTION(NAME, COUNT, ROUNDS, INTRINSIC)
#include "llvm/IR/ConstrainedOps.def"
  default:
    return nullptr;
  }
  if (Instruction::isCast(Opcode))
    return Builder.CreateCast(Instruction::CastOps(Opcode), Operands[0], Call.getType());
  if (Opcode)
    return Builder.CreateBinOp(Instruction::BinaryOps(Opcode), Operands[0], Operands[1]);
  return Builder.CreateIntrinsic(Call.getType(), Plain, Operands);
}

/// Replaces a NaN by the machine's. fmin does that to a binary32 number, unless LLVM folds it.
static Value *createCanonical(IRBuilder<> &Builder, Value *X) {
  Type *Ty = X->getType();
  if (Ty->getScalarType()->isFloatTy() && !isa<Constant>(X))
    return Builder.CreateBinaryIntrinsic(Intrinsic::minnum, X, X);
  return Builder.CreateSelect(Builder.CreateFCmpUNO(X, X), ConstantFP::getQNaN(Ty), X);
}

/// The lesser or the greater number, -0 below +0; a NaN if there is one.
static Value *createExtreme(IRBuilder<> &Builder, Value *X, Value *Y, bool IsLeast) {
  Type *Ty = X->getType();
  Type *Bits = Ty->getWithNewType(Builder.getIntNTy(Ty->getScalarSizeInBits()));
  Value *First = IsLeast ? Builder.CreateFCmpOLT(X, Y) : Builder.CreateFCmpOGT(X, Y);
  Value *XBits = Builder.CreateBitCast(X, Bits), *YBits = Builder.CreateBitCast(Y, Bits);
  Value *Both =
      IsLeast ? Builder.CreateOr(XBits, YBits) : Builder.CreateAnd(XBits, YBits); // for equal numbers and for zeros
  Value *Number = Builder.CreateSelect(Builder.CreateFCmpOEQ(X, Y), Builder.CreateBitCast(Both, Ty),
                                       Builder.CreateSelect(First, X, Y));
  return Builder.CreateSelect(Builder.CreateFCmpUNO(X, Y), ConstantFP::getQNaN(Ty), Number);
}

static Value *createOther(IRBuilder<> &Builder, IntrinsicInst &Call) {
  if (auto *Constrained = dyn_cast<ConstrainedFPIntrinsic>(&Call))
    return createPlain(Builder, *Constrained);
  if (Call.getIntrinsicID() == Intrinsic::canonicalize)
    return createCanonical(Builder, Call.getArgOperand(0));
  const Type *Operand = Call.arg_size() ? Call.getArgOperand(0)->getType()->getScalarType() : nullptr;
  const bool IsHalf = Operand && (Operand->isHalfTy() || Operand->isBFloatTy());
  switch (Call.getIntrinsicID()) {
  case Intrinsic::arithmetic_fence:
    return IsHalf ? Call.getArgOperand(0) : nullptr;
  case Intrinsic::lrint:
  case Intrinsic::llrint:
  case Intrinsic::lround:
  case Intrinsic::llround:
    return IsHalf ? Builder.CreateIntrinsic(Call.getType(), Call.getIntrinsicID(),
                                            {Builder.CreateFPExt(Call.getArgOperand(0), Builder.getFloatTy())})
                  : nullptr;
  case Intrinsic::minimum:
  case Intrinsic::maximum: // selection expands these of binary32 numbers only
    return Operand->isFloatTy() || IsHalf ? nullptr
                                          : createExtreme(Builder, Call.getArgOperand(0), Call.getArgOperand(1),
                                                          Call.getIntrinsicID() == Intrinsic::minimum);
  case Intrinsic::set_rounding:
    Call.getContext().diagnose(
        DiagnosticInfoUnsupported(*Call.getFunction(), "the machine rounds to nearest", Call.getDebugLoc()));
    return PoisonValue::get(Builder.getInt32Ty()); // no value is used
  case Intrinsic::fptrunc_round:
    break;
  default:
    return nullptr;
  }
  const Metadata *Mode = cast<MetadataAsValue>(Call.getArgOperand(1))->getMetadata();
  if (cast<MDString>(Mode)->getString() != "round.tonearest")
    Call.getContext().diagnose(
        DiagnosticInfoUnsupported(*Call.getFunction(), "the machine rounds to nearest", Call.getDebugLoc()));
  return Builder.CreateFPTrunc(Call.getArgOperand(0), Call.getType());
}

namespace {

class TraxLowerFloats : public FunctionPass {
public:
  static char ID;
  TraxLowerFloats() : FunctionPass(ID) {}

  StringRef getPassName() const override { return "TRaX strict and canonical floats"; }
  void getAnalysisUsage(AnalysisUsage &AU) const override { AU.setPreservesCFG(); }

  bool runOnFunction(Function &F) override {
    bool Changed = F.hasFnAttribute(Attribute::StrictFP);
    F.removeFnAttr(Attribute::StrictFP); // arguments are converted strictly, too
    for (Instruction &I : make_early_inc_range(instructions(F))) {
      auto *Call = dyn_cast<IntrinsicInst>(&I);
      IRBuilder<> Builder(&I);
      Value *Other = Call ? createOther(Builder, *Call) : nullptr;
      if (!Other)
        continue;
      if (auto *Operation = dyn_cast<Instruction>(Other); Operation && Operation != Call->getArgOperand(0))
        if (isa<FPMathOperator>(Operation) && isa<FPMathOperator>(Call))
          Operation->copyFastMathFlags(Call);
      if (!Call->use_empty())
        Call->replaceAllUsesWith(Other);
      Call->eraseFromParent();
      Changed = true;
    }
    return Changed;
  }
};

} // namespace

char TraxLowerFloats::ID = 0;

INITIALIZE_PASS(TraxLowerFloats, DEBUG_TYPE, "TRaX strict and canonical floats", false, false)

FunctionPass *llvm::createTraxLowerFloatsPass() {
  return new TraxLowerFloats();
}
