//===- Trax.h - The target's passes --------------------------------------===//
#ifndef TRAX_TRAX_H
#define TRAX_TRAX_H

#include "MCTargetDesc/TraxBaseInfo.h"
#include "MCTargetDesc/TraxMCTargetDesc.h"
#include "llvm/IR/Instructions.h"
#include "llvm/Support/CodeGen.h"

namespace llvm {

class FunctionPass;
class MachineInstr;
class PassRegistry;
class TargetInstrInfo;
class TraxTargetMachine;

/// Selects machine instructions.
FunctionPass *createTraxISelDag(TraxTargetMachine &TM, CodeGenOptLevel OptLevel);
/// Replaces strict and canonical floats by plain ones.
FunctionPass *createTraxLowerFloatsPass();
/// Replaces va_arg by loads, for every type.
FunctionPass *createTraxLowerVAArgPass();
/// Expands integer divisions by the machine's units.
FunctionPass *createTraxDivisionPass();
/// Lets pointers step in loops around others.
FunctionPass *createTraxLoopsPass();
/// Lets phis take values that branches have compared with constants.
FunctionPass *createTraxBranchesPass();

/// Replaces atomic operations that the machine lacks by calls.
FunctionPass *createTraxLowerAtomicsPass();

/// Whether the machine has this operation: the increment of a word by 1.
bool isTraxAtomicIncrement(const AtomicRMWInst &RMW);
/// The library's function for an operation, without the size in bytes that ends its name; empty if there is none.
StringRef getTraxAtomicFunction(AtomicRMWInst::BinOp Operation);

/// Writes out __builtin_longjmp, once registers are allocated.
void expandTraxLongJmp(MachineInstr &MI, const TargetInstrInfo &TII);

void initializeTraxBranchesPass(PassRegistry &);
void initializeTraxDAGToDAGISelLegacyPass(PassRegistry &);
void initializeTraxDivisionPass(PassRegistry &);
void initializeTraxLoopsPass(PassRegistry &);
void initializeTraxLowerAtomicsPass(PassRegistry &);
void initializeTraxLowerFloatsPass(PassRegistry &);
void initializeTraxLowerVAArgPass(PassRegistry &);

} // namespace llvm

#endif
