//===- TraxLowerAtomics.cpp - Accesses by the memory that they reach -----===//
//
// This pass alone decides whether an access is known to reach local memory (isLocalMemory). Only one thread reaches
// local memory, and no cache holds it: atomic accesses of it become plain ones, and nontemporal ones temporal.
//
// In global memory the machine loads, stores and increments atomically. Every other read-modify-write becomes a call of
// the runtime's function with libatomic's name, which takes a lock. An increment or a store between the load and the
// store of such a call would be lost. So both stay machine instructions only if all uses of the object are visible and
// none is such a call; otherwise they take the lock as well. A load never needs it.
//
// Only fences order the machine's own accesses. This pass adds them (docs/abi.md, "Atomics"); the library's functions
// have theirs.
//
// Runs after AtomicExpand, which has reduced operations without a function to compare-and-exchange, and has replaced
// operations wider than a word by calls.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "TraxBuiltins.h"
#include "TraxSubtarget.h"
#include "TraxTargetMachine.h"
#include "llvm/ADT/STLExtras.h"
#include "llvm/Analysis/MemoryLocation.h"
#include "llvm/Analysis/ValueTracking.h"
#include "llvm/CodeGen/TargetPassConfig.h"
#include "llvm/IR/Constants.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/IntrinsicInst.h"
#include "llvm/IR/Module.h"
#include "llvm/IR/Operator.h"
#include "llvm/InitializePasses.h"
#include "llvm/Pass.h"
#include "llvm/Support/AtomicOrdering.h"
#include "llvm/Transforms/Utils/LowerAtomic.h"

using namespace llvm;

#define DEBUG_TYPE "trax-lower-atomics"

bool llvm::isTraxAtomicIncrement(const AtomicRMWInst &RMW) {
  const auto *Amount = dyn_cast<ConstantInt>(RMW.getValOperand());
  return Amount && Amount->getType()->isIntegerTy(32) &&
         ((RMW.getOperation() == AtomicRMWInst::Add && Amount->isOne()) ||
          (RMW.getOperation() == AtomicRMWInst::Sub && Amount->isMinusOne()));
}

StringRef llvm::getTraxAtomicFunction(AtomicRMWInst::BinOp Operation) {
  switch (Operation) {
  case AtomicRMWInst::Xchg:
    return "__atomic_exchange_";
  case AtomicRMWInst::Add:
    return "__atomic_fetch_add_";
  case AtomicRMWInst::Sub:
    return "__atomic_fetch_sub_";
  case AtomicRMWInst::And:
    return "__atomic_fetch_and_";
  case AtomicRMWInst::Or:
    return "__atomic_fetch_or_";
  case AtomicRMWInst::Xor:
    return "__atomic_fetch_xor_";
  case AtomicRMWInst::Nand:
    return "__atomic_fetch_nand_";
  default:
    return "";
  }
}

namespace {

class TraxLowerAtomics : public FunctionPass {
public:
  static char ID;
  TraxLowerAtomics() : FunctionPass(ID) {}

  StringRef getPassName() const override { return "TRaX atomic operations to calls"; }
  bool runOnFunction(Function &F) override;
  void getAnalysisUsage(AnalysisUsage &AU) const override {
    AU.addRequired<TargetPassConfig>();
    AU.setPreservesCFG();
  }

private:
  static void lower(StoreInst &Store);
  static void lower(AtomicRMWInst &RMW);
  static void lower(AtomicCmpXchgInst &CmpXchg);
  static bool lowerOrKeep(Instruction &I, const TraxSubtarget &Subtarget);
  static bool mergeFences(BasicBlock &BB);
};

} // namespace

/// Calls NAME##SIZE(Arguments...). Small integers are zero-extended, as those of an unsigned C type.
static CallInst *callLibrary(IRBuilder<> &Builder, StringRef Name, Type *ObjectTy, Type *ResultTy,
                             ArrayRef<Value *> Arguments) {
  Module &M = *Builder.GetInsertBlock()->getModule();
  SmallVector<Type *, 5> Types;
  for (Value *Argument : Arguments)
    Types.push_back(Argument->getType());
  std::string FullName = (Name + Twine(ObjectTy->getIntegerBitWidth() / 8)).str();
  FunctionCallee Callee = M.getOrInsertFunction(FullName, FunctionType::get(ResultTy, Types, /*isVarArg=*/false));
  CallInst *Call = Builder.CreateCall(Callee, Arguments);
  Call->setDoesNotThrow();
  auto IsSmall = [](Type *Ty) { return Ty->isIntegerTy() && Ty->getIntegerBitWidth() < 32; };
  for (unsigned I = 0; I != Arguments.size(); ++I)
    if (IsSmall(Types[I]))
      Call->addParamAttr(I, Attribute::ZExt);
  if (IsSmall(ResultTy))
    Call->addRetAttr(Attribute::ZExt);
  return Call;
}

static Value *orderingOf(IRBuilder<> &Builder, AtomicOrdering Ordering) {
  return Builder.getInt32(unsigned(toCABI(Ordering)));
}

/// Whether every use of the pointer is a load, a store or an increment.
static bool isOnlyCounted(const Value &Pointer) {
  return all_of(Pointer.uses(), [&](const Use &U) {
    const User *Where = U.getUser();
    if (isa<LoadInst>(Where))
      return true;
    if (isa<StoreInst>(Where))
      return U.getOperandNo() == StoreInst::getPointerOperandIndex();
    if (const auto *RMW = dyn_cast<AtomicRMWInst>(Where))
      return isTraxAtomicIncrement(*RMW) && U.getOperandNo() == AtomicRMWInst::getPointerOperandIndex();
    if (const auto *Call = dyn_cast<CallBase>(Where)) {
      const Function *Callee = Call->getCalledFunction();
      return isa<MemIntrinsic>(Call) || Call->isLifetimeStartOrEnd() ||
             (Callee && TraxBuiltin::find(Callee->getName()) == TraxBuiltin::Ainc);
    }
    const auto *Derived = dyn_cast<Operator>(Where);
    return Derived && (isa<GEPOperator>(Derived) || isa<BitCastOperator>(Derived)) && isOnlyCounted(*Derived);
  });
}

/// Whether the address is known to be in local memory: of a thread-local object, or of the stack if that is there.
static bool isLocalMemory(const Value *Address, const TraxSubtarget &Subtarget) {
  const Value *Object = getUnderlyingObject(Address, /*MaxLookup=*/0);
  if (const auto *Global = dyn_cast<GlobalVariable>(Object))
    return Global->isThreadLocal();
  const auto *Passed = dyn_cast<Argument>(Object);
  return (isa<AllocaInst>(Object) || (Passed && Passed->hasByValAttr())) && Subtarget.getStack() == TRAX_EF_STACK_LOCAL;
}

/// Whether an increment of or a store to this address, in global memory, needs no lock.
static bool isLockFree(const Value *Address, const TraxSubtarget &Subtarget) {
  const Value *Object = getUnderlyingObject(Address);
  const auto *Global = dyn_cast<GlobalVariable>(Object);
  const bool HasVisibleUses = isa<AllocaInst>(Object) ? Subtarget.getStack() == TRAX_EF_STACK_GLOBAL // else ainc faults
                                                      : Global && Global->hasLocalLinkage();
  return HasVisibleUses && isOnlyCounted(*Object);
}

static void fenceBefore(Instruction &I, AtomicOrdering Ordering) {
  IRBuilder<>(&I).CreateFence(Ordering);
}

static void fenceBehind(Instruction &I, AtomicOrdering Ordering) {
  IRBuilder<>(I.getNextNode()).CreateFence(Ordering);
}

/// The fences of an access that the machine performs.
static void addFences(Instruction &Access, AtomicOrdering Ordering) {
  const bool Stores = !isa<LoadInst>(Access), Loads = !isa<StoreInst>(Access);
  if (Stores && isReleaseOrStronger(Ordering))
    fenceBefore(Access, AtomicOrdering::Release);
  if (Loads && isAcquireOrStronger(Ordering))
    fenceBehind(Access, AtomicOrdering::Acquire);
  else if (Ordering == AtomicOrdering::SequentiallyConsistent) // a later load must not come before the store
    fenceBehind(Access, AtomicOrdering::Release);
}

/// void __atomic_store_N(object, value, order)
void TraxLowerAtomics::lower(StoreInst &Store) {
  IRBuilder<> Builder(&Store);
  Value *Stored = Store.getValueOperand();
  Type *Ty = Builder.getIntNTy(Store.getDataLayout().getTypeSizeInBits(Stored->getType()));
  callLibrary(Builder, "__atomic_store_", Ty, Builder.getVoidTy(),
              {Store.getPointerOperand(), Builder.CreateBitOrPointerCast(Stored, Ty),
               orderingOf(Builder, Store.getOrdering())});
  Store.eraseFromParent();
}

void TraxLowerAtomics::lower(AtomicRMWInst &RMW) {
  IRBuilder<> Builder(&RMW);
  Value *Old = callLibrary(Builder, getTraxAtomicFunction(RMW.getOperation()), RMW.getType(), RMW.getType(),
                           {RMW.getPointerOperand(), RMW.getValOperand(), orderingOf(Builder, RMW.getOrdering())});
  RMW.replaceAllUsesWith(Old);
  RMW.eraseFromParent();
}

/// bool __atomic_compare_exchange_N(object, &expected, desired, success order, failure order)
void TraxLowerAtomics::lower(AtomicCmpXchgInst &CmpXchg) {
  Type *Ty = CmpXchg.getNewValOperand()->getType();
  BasicBlock &Entry = CmpXchg.getFunction()->getEntryBlock();
  AllocaInst *Expected = IRBuilder<>(&Entry, Entry.getFirstInsertionPt()).CreateAlloca(Ty, nullptr, "expected");
  IRBuilder<> Builder(&CmpXchg);
  Builder.CreateStore(CmpXchg.getCompareOperand(), Expected);
  Value *Success = callLibrary(Builder, "__atomic_compare_exchange_", Ty, Builder.getInt1Ty(),
                               {CmpXchg.getPointerOperand(), Expected, CmpXchg.getNewValOperand(),
                                orderingOf(Builder, CmpXchg.getSuccessOrdering()),
                                orderingOf(Builder, CmpXchg.getFailureOrdering())});
  Value *Old = Builder.CreateLoad(Ty, Expected);
  Value *Result = Builder.CreateInsertValue(PoisonValue::get(CmpXchg.getType()), Old, 0);
  Result = Builder.CreateInsertValue(Result, Success, 1);
  CmpXchg.replaceAllUsesWith(Result);
  CmpXchg.eraseFromParent();
}

/// Replaces an access to local memory by a plain one.
static void makePlain(Instruction &I) {
  I.setMetadata(LLVMContext::MD_nontemporal, nullptr);
  if (auto *Load = dyn_cast<LoadInst>(&I))
    Load->setAtomic(AtomicOrdering::NotAtomic);
  else if (auto *Store = dyn_cast<StoreInst>(&I))
    Store->setAtomic(AtomicOrdering::NotAtomic);
  else if (auto *RMW = dyn_cast<AtomicRMWInst>(&I))
    lowerAtomicRMWInst(RMW);
  else
    lowerAtomicCmpXchgInst(cast<AtomicCmpXchgInst>(&I));
}

/// Replaces an atomic access by a plain one or by a call, or adds the fences that it needs.
bool TraxLowerAtomics::lowerOrKeep(Instruction &I, const TraxSubtarget &Subtarget) {
  const bool IsAtomic = I.isAtomic() && !isa<FenceInst>(I);
  if (!IsAtomic && !I.hasMetadata(LLVMContext::MD_nontemporal))
    return false;
  const std::optional<MemoryLocation> Location = MemoryLocation::getOrNone(&I);
  if (!Location)
    return false;
  const Value *Address = Location->Ptr;
  if (isLocalMemory(Address, Subtarget)) {
    makePlain(I);
    return true;
  }
  if (!IsAtomic)
    return false;
  if (auto *Load = dyn_cast<LoadInst>(&I)) {
    addFences(*Load, Load->getOrdering());
  } else if (auto *Store = dyn_cast<StoreInst>(&I)) {
    if (isLockFree(Address, Subtarget))
      addFences(*Store, Store->getOrdering());
    else
      lower(*Store);
  } else if (auto *RMW = dyn_cast<AtomicRMWInst>(&I)) {
    if (isTraxAtomicIncrement(*RMW) && isLockFree(Address, Subtarget))
      addFences(*RMW, RMW->getOrdering());
    else
      lower(*RMW);
  } else {
    lower(cast<AtomicCmpXchgInst>(I));
  }
  return true;
}

/// Fences without an access between them become one.
bool TraxLowerAtomics::mergeFences(BasicBlock &BB) {
  bool Changed = false;
  FenceInst *Before = nullptr;
  for (Instruction &I : make_early_inc_range(BB)) {
    auto *Fence = dyn_cast<FenceInst>(&I);
    if (!Fence) {
      Before = I.mayReadOrWriteMemory() ? nullptr : Before;
    } else if (Fence->getSyncScopeID() != SyncScope::SingleThread) {
      if (Before) {
        if (Fence->getOrdering() != Before->getOrdering())
          Fence->setOrdering(AtomicOrdering::SequentiallyConsistent);
        Before->eraseFromParent();
        Changed = true;
      }
      Before = Fence;
    }
  }
  return Changed;
}

bool TraxLowerAtomics::runOnFunction(Function &F) {
  const auto &Subtarget = getAnalysis<TargetPassConfig>().getTM<TraxTargetMachine>().getSubtarget<TraxSubtarget>(F);
  bool Changed = false;
  for (Instruction &I : make_early_inc_range(instructions(F)))
    Changed |= lowerOrKeep(I, Subtarget);
  for (BasicBlock &BB : F)
    Changed |= mergeFences(BB);
  return Changed;
}

char TraxLowerAtomics::ID = 0;

INITIALIZE_PASS(TraxLowerAtomics, DEBUG_TYPE, "TRaX atomic operations to calls", false, false)

FunctionPass *llvm::createTraxLowerAtomicsPass() {
  return new TraxLowerAtomics();
}
