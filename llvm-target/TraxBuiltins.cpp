//===- TraxBuiltins.cpp - The machine's own operations, as calls ---------===//
#include "TraxBuiltins.h"
#include "trax/abi.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/StringSwitch.h"
#include "llvm/IR/Constants.h"
#include "llvm/IR/Function.h"
#include "llvm/IR/IRBuilder.h"
#include "llvm/IR/InstrTypes.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/Module.h"
#include "llvm/Support/ModRef.h"
#include <cstring>

using namespace llvm;

std::optional<TraxBuiltin::ID> TraxBuiltin::find(StringRef Name) {
  return StringSwitch<std::optional<ID>>(Name)
#define BUILTIN(ID, NAME, TYPE, ATTRIBUTES) .Case("__builtin_trax_" #NAME, ID)
#include "TraxBuiltins.def"
      .Default(std::nullopt);
}

TraxBuiltin::Signature TraxBuiltin::signature(ID Builtin) {
  static const char *const Types[] = {
#define BUILTIN(ID, NAME, TYPE, ATTRIBUTES) TYPE,
#include "TraxBuiltins.def"
  };
  Signature Result;
  // The list uses a part of clang's notation: U and I before a type, f, i and v, and * after one.
  bool IsResult = true;
  for (const char *At = Types[Builtin]; *At; IsResult = false) {
    At += strspn(At, "UI");
    const bool IsPointer = At[1] == '*';
    if (*At != 'v') {
      const MVT Type = *At == 'f' && !IsPointer ? MVT::f32 : MVT::i32;
      if (IsResult)
        Result.Results.push_back(Type);
      else
        Result.Arguments.push_back(Type);
    }
    At += IsPointer ? 2 : 1;
  }
  return Result;
}

/// Special registers other than the cycle counter hold the same value as long as the thread runs.
static void markConstantReads(Function &Rdsr) {
  for (User *U : Rdsr.users()) {
    auto *Call = dyn_cast<CallInst>(U);
    if (!Call || Call->getCalledFunction() != &Rdsr || Call->arg_size() != 1)
      continue;
    auto *Number = dyn_cast<ConstantInt>(Call->getArgOperand(0));
    if (!Number || Number->getZExtValue() > TRAX_SR_THREADS)
      continue;
    Call->setDoesNotAccessMemory();
    Call->addFnAttr(Attribute::WillReturn);
    Call->addFnAttr(Attribute::NoSync);
  }
}

/// The message for a failed check of undefined behaviour, by clang's number for it (SanitizerHandler).
static StringRef nameOfCheck(uint64_t Number) {
  static constexpr StringLiteral Names[] = {"addition overflows",
                                            "unreachable code is reached",
                                            "control flow integrity is violated",
                                            "division by zero, or it overflows",
                                            "wrong dynamic type",
                                            "conversion from floating point overflows",
                                            "function called through a pointer of another type",
                                            "implicit conversion changes the value",
                                            "invalid argument of a builtin",
                                            "invalid cast of an object",
                                            "load of a value that its type does not have",
                                            "no return from a function with a result",
                                            "multiplication overflows",
                                            "negation overflows",
                                            "null argument where none may be",
                                            "null result where none may be",
                                            "null argument where none may be",
                                            "null result where none may be",
                                            "index out of bounds",
                                            "pointer arithmetic overflows",
                                            "shift out of range",
                                            "subtraction overflows",
                                            "access by a null or misaligned pointer, or beyond its object",
                                            "assumption about alignment does not hold",
                                            "array of variable length has no length"};
  return Number < std::size(Names) ? StringRef(Names[Number]) : "a check failed";
}

/// A check of undefined behaviour that fails ends in the trap `abort` with a message that names the check.
static bool explainChecks(Module &M) {
  Function *Check = M.getFunction("llvm.ubsantrap");
  if (!Check)
    return false;
  IRBuilder<> Builder(M.getContext());
  FunctionCallee Trap =
      M.getOrInsertFunction("__builtin_trax_trap", Builder.getVoidTy(), Builder.getInt32Ty(), Builder.getInt32Ty());
  DenseMap<uint64_t, Constant *> Messages;
  for (User *U : make_early_inc_range(Check->users())) {
    auto *Call = cast<CallInst>(U);
    const uint64_t Number = cast<ConstantInt>(Call->getArgOperand(0))->getZExtValue();
    Constant *&Message = Messages[Number];
    if (!Message)
      Message = Builder.CreateGlobalString(("undefined behaviour: " + nameOfCheck(Number)).str(), "", 0, &M);
    Builder.SetInsertPoint(Call);
    Value *Address = Builder.CreatePtrToInt(Message, Builder.getInt32Ty());
    CallInst *Replaced = Builder.CreateCall(Trap, {Address, Builder.getInt32(TRAX_TRAP_ABORT)});
    Replaced->setAttributes(Call->getAttributes().removeParamAttributes(M.getContext(), 0));
    Replaced->setDoesNotReturn();
    Replaced->setDoesNotThrow();
    Replaced->addFnAttr(Attribute::Cold);
    Call->eraseFromParent();
  }
  return true;
}

PreservedAnalyses TraxBuiltinsPass::run(Module &M, ModuleAnalysisManager &) {
  bool Changed = explainChecks(M);
  for (Function &F : M) {
    std::optional<TraxBuiltin::ID> Builtin = TraxBuiltin::find(F.getName());
    if (!Builtin || !F.isDeclaration())
      continue;
    Changed = true;
    F.setDoesNotThrow();
    switch (*Builtin) {
#define BUILTIN(ID, NAME, TYPE, ATTRIBUTES)
#define GROUPS(ID, NAME, TYPE, INSTRUCTION) case TraxBuiltin::ID:
#include "TraxBuiltins.def"
    case TraxBuiltin::Opaque:
    case TraxBuiltin::Rsqrt: // traps never: may be executed where the source would not
      F.setDoesNotAccessMemory();
      F.setWillReturn();
      F.addFnAttr(Attribute::NoSync);
      F.addFnAttr(Attribute::NoFree);
      F.setSpeculatable();
      break;
    case TraxBuiltin::Rdsr: // may read the cycle counter: neither merged nor reordered
      F.addFnAttr(Attribute::NoFree);
      markConstantReads(F);
      break;
    case TraxBuiltin::Trap:
      F.addFnAttr(Attribute::NoFree);
      break;
    case TraxBuiltin::Halt:
      F.setDoesNotReturn();
      break;
    case TraxBuiltin::Ainc:
      F.setWillReturn();
      F.addFnAttr(Attribute::NoFree);
      break;
    }
  }
  return Changed ? PreservedAnalyses::none() : PreservedAnalyses::all();
}
