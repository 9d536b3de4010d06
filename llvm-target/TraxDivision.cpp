//===- TraxDivision.cpp - Integer division by the machine's units ---------===//
//
// Before instruction selection: a division of words becomes an estimate of the quotient, the remainder n - q * d, and a
// branch. Only the right quotient has a remainder from 0 to d - 1, so a quotient that passes the branch is right, for
// any precision of the unit. A wrong estimate is refined.
//
// - In general the estimate is float(n) / float(d). Three roundings to 24 bits change it by less than 2^-22 of itself:
//   it is nearly always right below 2^20. If n and d have 24 bits it always is: only the quotient is rounded, and from
//   k - 1/d to k only if k * d >= 2^25, but k * d < n + d.
// - A divisor that a loop does not change gets a reciprocal before the loop, which leaves four instructions in it.
//
// Refining adds the estimate for the remainder to the quotient, until the remainder is right. It ends: a remainder of d
// or more has an estimate of at least 1, since rounding is monotonic, and no estimate is wrong by more than a third, as
// of a unit with one bit that rounds 1.5 to 2. For the same reason a remainder below 0 fits in a signed word.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/PostOrderIterator.h"
#include "llvm/Analysis/AssumptionCache.h"
#include "llvm/Analysis/LoopInfo.h"
#include "llvm/Analysis/ValueTracking.h"
#include "llvm/IR/Dominators.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/MDBuilder.h"
#include "llvm/IR/PatternMatch.h"
#include "llvm/InitializePasses.h"
#include "llvm/Pass.h"
#include <map>
#include <tuple>

using namespace llvm;
using namespace llvm::PatternMatch;

#define DEBUG_TYPE "trax-division"

namespace {

/// Divisions and remainders of the same operands in a block, and what is known of the operands.
struct Division {
  SmallVector<BinaryOperator *, 2> Quotients, Remainders;
  BinaryOperator *First;                      ///< of those in the block; a remainder may be n - q * d in another one
  bool IsSigned;                              ///< otherwise the next two are false
  bool IsDividendNegative, IsDivisorNegative; ///< may be
  bool IsDivisorLarge, IsDivisorZero;         ///< may have its top bit, may be 0
  Instruction *Before = nullptr;              ///< where the divisor's reciprocal is computed, if it is
};

struct Result {
  Value *Quotient, *Remainder;
};

/// For dividends that are not negative.
struct Reciprocal {
  Value *Divisor; ///< its amount, at least 1
  Value *Sign;    ///< all ones if it is negative, else 0; none if it cannot be
  Value *Factor;  ///< 2^32 / Divisor, or less
};

/// The reciprocals by place and divisor, with or without its sign.
using ReciprocalMap = std::map<std::tuple<Instruction *, Value *, bool>, Reciprocal>;

class TraxDivision : public FunctionPass {
public:
  static char ID;
  TraxDivision() : FunctionPass(ID) {}

  StringRef getPassName() const override { return "TRaX integer division"; }
  void getAnalysisUsage(AnalysisUsage &AU) const override { AU.addRequired<AssumptionCacheTracker>(); }
  bool runOnFunction(Function &F) override;
};

} // namespace

// --- the divisions of a function ----------------------------------------------

/// Returns the place for the reciprocal of the divisor: before the outermost loop in which the divisor is invariant and
/// each iteration divides. Returns null if there is none.
static Instruction *placeOfReciprocal(const BinaryOperator &I, const LoopInfo &LI, const DominatorTree &DT) {
  Instruction *Place = nullptr;
  const BasicBlock *Block = I.getParent();
  for (const Loop *L = LI.getLoopFor(Block); L && L->isLoopInvariant(I.getOperand(1)); L = L->getParentLoop()) {
    const BasicBlock *Latch = L->getLoopLatch();
    BasicBlock *Preheader = L->getLoopPreheader();
    if (!Latch || !Preheader || !DT.dominates(Block, Latch))
      break;
    Place = Preheader->getTerminator();
    Block = Preheader;
  }
  return Place;
}

/// The remainder may have become n - q * d.
static void findRemainders(Division &Div, BinaryOperator &Quotient) {
  for (User *Product : Quotient.users())
    if (match(Product, m_c_Mul(m_Specific(&Quotient), m_Specific(Quotient.getOperand(1)))))
      for (User *Rest : Product->users())
        if (match(Rest, m_Sub(m_Specific(Quotient.getOperand(0)), m_Specific(Product))))
          Div.Remainders.push_back(cast<BinaryOperator>(Rest));
}

static std::vector<Division> findDivisions(Function &F, AssumptionCache &AC) {
  std::vector<Division> Found;
  std::optional<DominatorTree> DT;
  std::optional<LoopInfo> LI;
  // In this order a divisor that is itself a quotient has been written out before.
  for (BasicBlock *Block : ReversePostOrderTraversal<Function *>(&F)) {
    MapVector<std::tuple<unsigned, Value *, Value *>, Division> InBlock;
    for (Instruction &I : *Block) {
      const unsigned Opcode = I.getOpcode();
      const bool IsQuotient = Opcode == Instruction::SDiv || Opcode == Instruction::UDiv;
      const bool IsSigned = Opcode == Instruction::SDiv || Opcode == Instruction::SRem;
      if ((!IsQuotient && Opcode != Instruction::SRem && Opcode != Instruction::URem) ||
          isa<Constant>(I.getOperand(1)) || !I.getType()->isIntegerTy() || I.getType()->getIntegerBitWidth() > 32)
        continue;
      auto &Operation = cast<BinaryOperator>(I);
      Value *N = I.getOperand(0), *D = I.getOperand(1);
      auto [Entry, IsNew] = InBlock.insert({{unsigned(IsSigned), N, D}, Division()});
      Division &Div = Entry->second;
      (IsQuotient ? Div.Quotients : Div.Remainders).push_back(&Operation);
      if (IsQuotient)
        findRemainders(Div, Operation);
      if (!IsNew)
        continue;
      if (!DT) {
        DT.emplace(F);
        LI.emplace(*DT);
      }
      const SimplifyQuery Query(F.getDataLayout(), nullptr, &*DT, &AC, &I);
      Div.First = &Operation;
      Div.IsDividendNegative = IsSigned && !isKnownNonNegative(N, Query);
      Div.IsDivisorNegative = IsSigned && !isKnownNonNegative(D, Query);
      Div.IsSigned = Div.IsDividendNegative || Div.IsDivisorNegative;
      Div.IsDivisorLarge = I.getType()->isIntegerTy(32) && !isKnownNonNegative(D, Query);
      Div.IsDivisorZero = !isKnownNonZero(D, Query);
      if (!Div.IsDividendNegative)
        Div.Before = placeOfReciprocal(Operation, *LI, *DT);
    }
    for (auto &[Key, Div] : InBlock)
      Found.push_back(std::move(Div));
  }
  return Found;
}

// --- arithmetic --------------------------------------------------------------

/// An operand as a word. It is used several times, so it is one value.
static Value *getWord(IRBuilder<> &Builder, Value *V, bool IsSigned) {
  if (!isGuaranteedNotToBeUndefOrPoison(V))
    V = Builder.CreateFreeze(V);
  return Builder.CreateIntCast(V, Builder.getInt32Ty(), IsSigned);
}

/// All ones if the word is negative, else 0.
static Value *signOf(IRBuilder<> &Builder, Value *V) {
  return Builder.CreateAShr(V, 31);
}

/// The word, or its negative if the sign is all ones. No sign is 0.
static Value *withSign(IRBuilder<> &Builder, Value *V, Value *Sign) {
  return Sign ? Builder.CreateSub(Builder.CreateXor(V, Sign), Sign) : V;
}

static Value *highWord(IRBuilder<> &Builder, Value *A, Value *B) {
  Type *Wide = Builder.getInt64Ty();
  Value *Product = Builder.CreateMul(Builder.CreateZExt(A, Wide), Builder.CreateZExt(B, Wide));
  return Builder.CreateTrunc(Builder.CreateLShr(Product, 32), Builder.getInt32Ty());
}

static Value *toFloat(IRBuilder<> &Builder, Value *V, bool IsSigned) {
  return IsSigned ? Builder.CreateSIToFP(V, Builder.getFloatTy()) : Builder.CreateUIToFP(V, Builder.getFloatTy());
}

/// Towards zero, saturating.
static Value *toWord(IRBuilder<> &Builder, Value *V, bool IsSigned) {
  return Builder.CreateIntrinsic(IsSigned ? Intrinsic::fptosi_sat : Intrinsic::fptoui_sat,
                                 {Builder.getInt32Ty(), Builder.getFloatTy()}, {V});
}

/// The factor is less than 2^32 / d, by less than 2 with a unit of 24 bits. The dividend is 2^-22 less than 2^32, which
/// is more than the roundings add. A unit of fewer bits may give too much, by a third: then half of it is a start. A
/// step of Newton's iteration, z += z * (2^32 - d * z) / 2^32, squares the relative error and stays below.
static Reciprocal createReciprocal(const Division &Div) {
  IRBuilder<> Builder(Div.Before);
  Builder.SetCurrentDebugLocation(Div.First->getDebugLoc());
  Value *D = getWord(Builder, Div.First->getOperand(1), Div.IsSigned), *Sign = nullptr;
  if (Div.IsDivisorNegative) {
    Sign = signOf(Builder, D);
    D = Builder.CreateBinaryIntrinsic(Intrinsic::abs, D, Builder.getFalse());
  }
  D = Builder.CreateBinaryIntrinsic(Intrinsic::umax, D, Builder.getInt32(1)); // the refinement for 0 would not end
  Value *Dividend = ConstantFP::get(Builder.getFloatTy(), 0x1p32 - 0x1p10);
  Value *Start = toWord(Builder, Builder.CreateFDiv(Dividend, toFloat(Builder, D, false)), false);
  Value *IsTooMuch = Builder.CreateICmpNE(highWord(Builder, Start, D), Builder.getInt32(0));
  Start = Builder.CreateSelect(IsTooMuch, Builder.CreateLShr(Start, 1), Start);
  Value *Rest = Builder.CreateNeg(Builder.CreateMul(D, Start));
  return {D, Sign, Builder.CreateAdd(Start, highWord(Builder, Start, Rest))};
}

// --- one division ------------------------------------------------------------

namespace {

class Writer {
  const Division &Div;
  Reciprocal *Inverse = nullptr;
  Value *N = nullptr, *D = nullptr, *FloatDivisor = nullptr;
  Value *Amount = nullptr;       ///< of the divisor
  Value *DividendSign = nullptr; ///< none if it cannot be negative

  Value *isRight(IRBuilder<> &Builder, Value *Remainder) {
    return Builder.CreateICmpULT(withSign(Builder, Remainder, DividendSign), Amount);
  }
  Result estimate(IRBuilder<> &Builder);
  Result refine(IRBuilder<> &Builder, Result Wrong);

public:
  Writer(const Division &Div, ReciprocalMap &Reciprocals);
  void write();
};

} // namespace

Writer::Writer(const Division &Div, ReciprocalMap &Reciprocals) : Div(Div) {
  if (!Div.Before)
    return;
  auto [Entry, IsNew] = Reciprocals.insert({{Div.Before, Div.First->getOperand(1), Div.IsDivisorNegative}, {}});
  if (IsNew)
    Entry->second = createReciprocal(Div);
  Inverse = &Entry->second;
}

Result Writer::estimate(IRBuilder<> &Builder) {
  Value *Quotient;
  if (Inverse) {
    Quotient = highWord(Builder, N, Inverse->Factor);
  } else {
    FloatDivisor = toFloat(Builder, D, Div.IsSigned);
    Quotient = toWord(Builder, Builder.CreateFDiv(toFloat(Builder, N, Div.IsSigned), FloatDivisor), Div.IsSigned);
    if (Div.IsDividendNegative)
      DividendSign = signOf(Builder, N);
    if (Div.IsDivisorNegative)
      Amount = Builder.CreateBinaryIntrinsic(Intrinsic::abs, D, Builder.getFalse());
  }
  return {Quotient, Builder.CreateSub(N, Builder.CreateMul(Quotient, D))};
}

Result Writer::refine(IRBuilder<> &Builder, Result Wrong) {
  Value *More;
  if (Inverse)
    More = Builder.CreateBinaryIntrinsic(Intrinsic::umax, highWord(Builder, Wrong.Remainder, Inverse->Factor),
                                         Builder.getInt32(1));
  else
    More = toWord(Builder, Builder.CreateFDiv(toFloat(Builder, Wrong.Remainder, true), FloatDivisor), true);
  const Result Next = {Builder.CreateAdd(Wrong.Quotient, More),
                       Builder.CreateSub(Wrong.Remainder, Builder.CreateMul(More, D))};
  if (Inverse) // its factor is never too large
    return Next;
  // Goes back by one if the remainder's sign is not the dividend's.
  Value *IsBelow = signOf(Builder, withSign(Builder, Next.Remainder, DividendSign));
  Value *One = Div.IsSigned ? Builder.CreateOr(signOf(Builder, Builder.CreateXor(N, D)), 1) : Builder.getInt32(1);
  Value *Back = withSign(Builder, Amount, DividendSign);
  return {Builder.CreateSub(Next.Quotient, Builder.CreateAnd(One, IsBelow)),
          Builder.CreateAdd(Next.Remainder, Builder.CreateAnd(Back, IsBelow))};
}

void Writer::write() {
  BasicBlock *Head = Div.First->getParent(), *Tail = Head->splitBasicBlock(Div.First);
  Head->getTerminator()->eraseFromParent();
  LLVMContext &Context = Head->getContext();
  MDBuilder Weights(Context);
  IRBuilder<> Builder(Head);
  Builder.SetCurrentDebugLocation(Div.First->getDebugLoc());
  auto AddBlock = [&] { return BasicBlock::Create(Context, "", Head->getParent(), Tail); };
  SmallVector<std::pair<BasicBlock *, Result>, 4> Ways;

  N = getWord(Builder, Div.First->getOperand(0), Div.IsSigned);
  D = Amount = Inverse ? Inverse->Divisor : getWord(Builder, Div.First->getOperand(1), Div.IsSigned);
  // Below a divisor d of more than 2^31 a quotient of 1 may look right: n - d modulo 2^32 is less than d. This test
  // costs what one for that would.
  if (!Inverse && !Div.IsSigned && Div.IsDivisorLarge) {
    BasicBlock *Divides = AddBlock();
    Builder.CreateCondBr(Builder.CreateICmpULT(N, D), Tail, Divides, Weights.createBranchWeights(1, 3));
    Ways.push_back({Head, {Builder.getInt32(0), N}});
    Builder.SetInsertPoint(Divides);
  }
  const Result First = estimate(Builder);
  Ways.push_back({Builder.GetInsertBlock(), First});
  BasicBlock *Entry = Builder.GetInsertBlock(), *Refines;
  if (!Inverse && Div.IsDivisorZero) { // no quotient by 0 is right: it must not be refined
    BasicBlock *Checks = AddBlock();
    Builder.CreateCondBr(isRight(Builder, First.Remainder), Tail, Checks, Weights.createLikelyBranchWeights());
    Builder.SetInsertPoint(Entry = Checks);
    Refines = AddBlock();
    Builder.CreateCondBr(Builder.CreateICmpEQ(D, Builder.getInt32(0)), Tail, Refines,
                         Weights.createUnlikelyBranchWeights());
    Ways.push_back({Checks, First});
  } else {
    Refines = AddBlock();
    Builder.CreateCondBr(isRight(Builder, First.Remainder), Tail, Refines, Weights.createLikelyBranchWeights());
  }
  Builder.SetInsertPoint(Refines);
  PHINode *Quotient = Builder.CreatePHI(Builder.getInt32Ty(), 2),
          *Remainder = Builder.CreatePHI(Builder.getInt32Ty(), 2);
  const Result Refined = refine(Builder, {Quotient, Remainder});
  Builder.CreateCondBr(isRight(Builder, Refined.Remainder), Tail, Refines, Weights.createLikelyBranchWeights());
  Ways.push_back({Refines, Refined});
  for (const auto &[From, Value] : {std::pair(Entry, First), std::pair(Refines, Refined)}) {
    Quotient->addIncoming(Value.Quotient, From);
    Remainder->addIncoming(Value.Remainder, From);
  }

  auto Replace = [&](ArrayRef<BinaryOperator *> Olds, Value *Result::*Part, Value *Sign) {
    if (Olds.empty())
      return;
    Builder.SetInsertPoint(Tail, Tail->begin());
    PHINode *Phi = Builder.CreatePHI(Builder.getInt32Ty(), Ways.size());
    for (const auto &[From, Values] : Ways)
      Phi->addIncoming(Values.*Part, From);
    Builder.SetInsertPoint(Tail, Tail->getFirstInsertionPt());
    Value *New = Builder.CreateIntCast(withSign(Builder, Phi, Sign), Olds.front()->getType(), Div.IsSigned);
    for (BinaryOperator *Old : Olds) {
      Old->replaceAllUsesWith(New);
      Old->eraseFromParent();
    }
  };
  Replace(Div.Quotients, &Result::Quotient, Inverse ? Inverse->Sign : nullptr);
  Replace(Div.Remainders, &Result::Remainder, nullptr);
}

bool TraxDivision::runOnFunction(Function &F) {
  if (skipFunction(F) || F.hasOptSize())
    return false;
  std::vector<Division> Divisions = findDivisions(F, getAnalysis<AssumptionCacheTracker>().getAssumptionCache(F));
  ReciprocalMap Reciprocals;
  for (const Division &Div : Divisions)
    Writer(Div, Reciprocals).write();
  return !Divisions.empty();
}

char TraxDivision::ID = 0;

INITIALIZE_PASS_BEGIN(TraxDivision, DEBUG_TYPE, "TRaX integer division", false, false)
INITIALIZE_PASS_DEPENDENCY(AssumptionCacheTracker)
INITIALIZE_PASS_END(TraxDivision, DEBUG_TYPE, "TRaX integer division", false, false)

FunctionPass *llvm::createTraxDivisionPass() {
  return new TraxDivision();
}
