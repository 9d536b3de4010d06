//===- TraxShrinkWrap.cpp - Registers are saved where paths need it ------===//
//
// LLVM's pass of this name runs first. It takes every load and store behind the first use of a saved register for one
// of the stack, and it gives up where a path from that use does not return. Where it finds no place, this pass looks at
// functions that have no address of their stack in a register. It finds one block to save registers in, and one to
// restore them in, which may be a new one on edges.
//
//===----------------------------------------------------------------------===//
#include "Trax.h"
#include "TraxFrameLowering.h"
#include "TraxSubtarget.h"
#include "llvm/ADT/PostOrderIterator.h"
#include "llvm/ADT/SCCIterator.h"
#include "llvm/CodeGen/MachineBlockFrequencyInfo.h"
#include "llvm/CodeGen/MachineDominators.h"
#include "llvm/CodeGen/MachineFrameInfo.h"
#include "llvm/CodeGen/MachineFunctionPass.h"
#include "llvm/CodeGen/MachineRegisterInfo.h"
#include "llvm/InitializePasses.h"

using namespace llvm;

#define DEBUG_TYPE "trax-shrink-wrap"

namespace {

using Blocks = SmallPtrSet<MachineBasicBlock *, 16>;

class TraxShrinkWrap : public MachineFunctionPass {
public:
  static char ID;
  TraxShrinkWrap() : MachineFunctionPass(ID) {}

  StringRef getPassName() const override { return "TRaX places of saved registers"; }
  void getAnalysisUsage(AnalysisUsage &AU) const override {
    AU.addRequired<MachineBlockFrequencyInfoWrapperPass>();
    AU.addRequired<MachineDominatorTreeWrapperPass>();
    MachineFunctionPass::getAnalysisUsage(AU);
  }
  MachineFunctionProperties getRequiredProperties() const override {
    return MachineFunctionProperties().set(MachineFunctionProperties::Property::NoVRegs);
  }
  bool runOnMachineFunction(MachineFunction &MF) override;

private:
  bool needsFrame(const MachineInstr &MI) const;
  bool findBlocks(MachineFunction &MF);
  MachineBasicBlock *findSave(MachineFunction &MF);
  MachineBasicBlock *findRestore(MachineFunction &MF, MachineBasicBlock *Save);
  MachineBasicBlock *blockOnEdges(MachineBasicBlock *Target, const Blocks &Sources);

  BitVector Saved;  // registers that a function owes its caller
  Blocks Users;     // blocks with an instruction that needs the frame
  Blocks BeforeUse; // blocks from which there is a way to one, which includes them
};

} // namespace

/// Whether an instruction is right only behind the prologue and before the epilogue.
bool TraxShrinkWrap::needsFrame(const MachineInstr &MI) const {
  if (MI.isDebugInstr())
    return false;
  return any_of(MI.operands(), [&](const MachineOperand &Operand) {
    if (Operand.isFI())
      return true;
    if (!Operand.isReg() || !Operand.getReg().isPhysical() || (Operand.isUse() && !Operand.readsReg()))
      return false;
    return Operand.getReg() == Trax::R2 ? !MI.isCall() : Saved.test(Operand.getReg());
  });
}

/// False: the function has an address of its stack in a register, or is left in other ways than by returning.
bool TraxShrinkWrap::findBlocks(MachineFunction &MF) {
  const TargetRegisterInfo &TRI = *MF.getSubtarget().getRegisterInfo();
  Saved.clear();
  Saved.resize(TRI.getNumRegs());
  for (const MCPhysReg *Register = TRI.getCalleeSavedRegs(&MF); *Register; ++Register)
    for (MCRegAliasIterator Alias(*Register, &TRI, /*IncludeSelf=*/true); Alias.isValid(); ++Alias)
      Saved.set(*Alias);
  Users.clear();
  BeforeUse.clear();
  SmallVector<MachineBasicBlock *, 16> Worklist;
  for (MachineBasicBlock &Block : MF) {
    if (Block.isEHPad() || Block.hasAddressTaken())
      return false;
    for (const MachineInstr &MI : Block) {
      if (!needsFrame(MI))
        continue;
      if (!MI.mayLoadOrStore() && any_of(MI.operands(), [](const MachineOperand &O) { return O.isFI(); }))
        return false;
      if (Users.insert(&Block).second)
        Worklist.push_back(&Block);
    }
  }
  while (!Worklist.empty()) {
    MachineBasicBlock *Block = Worklist.pop_back_val();
    if (BeforeUse.insert(Block).second)
      append_range(Worklist, Block->predecessors());
  }
  return true;
}

static Blocks reachableFrom(MachineBasicBlock *Begin) {
  Blocks Reached;
  SmallVector<MachineBasicBlock *, 16> Worklist(Begin->successors());
  while (!Worklist.empty()) {
    MachineBasicBlock *Block = Worklist.pop_back_val();
    if (Reached.insert(Block).second)
      append_range(Worklist, Block->successors());
  }
  return Reached;
}

static Blocks blocksInCycles(MachineFunction &MF) {
  Blocks InCycles;
  for (scc_iterator<MachineFunction *> Component = scc_begin(&MF); !Component.isAtEnd(); ++Component)
    if (Component.hasCycle())
      InCycles.insert(Component->begin(), Component->end());
  return InCycles;
}

/// The last block that is before all users and in no loop; null if that is no rarer than the entry.
MachineBasicBlock *TraxShrinkWrap::findSave(MachineFunction &MF) {
  MachineDominatorTree &Dominators = getAnalysis<MachineDominatorTreeWrapperPass>().getDomTree();
  const MachineBlockFrequencyInfo &Frequencies = getAnalysis<MachineBlockFrequencyInfoWrapperPass>().getMBFI();
  const Blocks InCycles = blocksInCycles(MF);
  MachineBasicBlock *Save = nullptr;
  for (MachineBasicBlock *User : Users) {
    if (!Dominators.isReachableFromEntry(User))
      return nullptr;
    Save = Save ? Dominators.findNearestCommonDominator(Save, User) : User;
  }
  while (Save && Save != &MF.front() && InCycles.contains(Save))
    Save = Dominators.getNode(Save)->getIDom()->getBlock();
  if (!Save || Save == &MF.front() || Frequencies.getBlockFreq(Save) >= Frequencies.getEntryFreq())
    return nullptr;
  return Save;
}

/// A new block on the edges from the sources to the target; null if a source is left in a way that cannot be changed.
MachineBasicBlock *TraxShrinkWrap::blockOnEdges(MachineBasicBlock *Target, const Blocks &Sources) {
  MachineFunction &MF = *Target->getParent();
  const TargetInstrInfo &TII = *MF.getSubtarget().getInstrInfo();
  for (MachineBasicBlock *Source : Sources) {
    MachineBasicBlock *True = nullptr, *False = nullptr;
    SmallVector<MachineOperand, 4> Condition;
    if (TII.analyzeBranch(*Source, True, False, Condition))
      return nullptr;
  }
  MachineBasicBlock *New = MF.CreateMachineBasicBlock();
  MF.push_back(New);
  for (const MachineBasicBlock::RegisterMaskPair &LiveIn : Target->liveins())
    New->addLiveIn(LiveIn);
  TII.insertUnconditionalBranch(*New, Target, DebugLoc());
  New->addSuccessor(Target);
  for (MachineBasicBlock &Source : MF) { // in their order: Sources has none
    if (!Sources.contains(&Source))
      continue;
    const bool FallsThrough = Source.getFallThrough(/*JumpToFallThrough=*/false) == Target;
    Source.ReplaceUsesOfBlockWith(Target, New);
    if (FallsThrough)
      TII.insertUnconditionalBranch(Source, New, Source.findBranchDebugLoc());
  }
  return New;
}

/// The block that every path passes once between the last user and the return; null if there is none. If no path
/// returns, a block that ends the program.
MachineBasicBlock *TraxShrinkWrap::findRestore(MachineFunction &MF, MachineBasicBlock *Save) {
  const MachineDominatorTree &Dominators = getAnalysis<MachineDominatorTreeWrapperPass>().getDomTree();
  Blocks Reached = reachableFrom(Save), Framed;
  Reached.insert(Save);
  for (MachineBasicBlock *Block : Reached)
    if (BeforeUse.contains(Block))
      Framed.insert(Block);
  const ReversePostOrderTraversal<MachineFunction *> Order(&MF);
  for (unsigned Tries = 0; Tries < 100; ++Tries) { // each looks at all blocks
    Blocks Sources, Targets;
    MachineBasicBlock *First = nullptr, *Dead = nullptr;
    bool Returns = false;
    for (MachineBasicBlock *Block : Order) {
      if (Framed.contains(Block)) {
        if (Block->isReturnBlock()) {
          Sources.insert(Block);
          Returns = true;
        } else if (Block->succ_empty()) {
          Dead = Block;
        }
        for (MachineBasicBlock *Successor : Block->successors())
          if (!Framed.contains(Successor)) {
            Sources.insert(Block);
            Targets.insert(Successor);
          }
      } else if (Targets.contains(Block) && !First) {
        First = Block;
      }
    }
    if (Sources.empty())
      return Dead;
    // What comes behind the restored registers must not need the frame again.
    const auto LeavesFrame = [&](MachineBasicBlock *Block) {
      return none_of(reachableFrom(Block), [&](MachineBasicBlock *Later) { return Framed.contains(Later); });
    };
    if (Sources.size() == 1) {
      MachineBasicBlock *Source = *Sources.begin();
      if (LeavesFrame(Source) && none_of(Source->terminators(), [&](MachineInstr &MI) { return needsFrame(MI); }))
        return Source;
    }
    if (Targets.size() == 1 && !Returns && LeavesFrame(*Targets.begin())) {
      MachineBasicBlock *Target = *Targets.begin();
      if (all_of(Target->predecessors(), [&](MachineBasicBlock *Block) { return Sources.contains(Block); }))
        return Target;
      return blockOnEdges(Target, Sources);
    }
    // Later: the frame lasts through the first block behind, and the next ones are looked at.
    if (!First || !Dominators.dominates(Save, First))
      return nullptr;
    Framed.insert(First);
  }
  return nullptr;
}

bool TraxShrinkWrap::runOnMachineFunction(MachineFunction &MF) {
  MachineFrameInfo &MFI = MF.getFrameInfo();
  const auto &TFL = *MF.getSubtarget<TraxSubtarget>().getFrameLowering();
  if (skipFunction(MF.getFunction()) || MFI.getSavePoint() || TFL.hasFP(MF) || MFI.hasOpaqueSPAdjustment() ||
      MF.exposesReturnsTwice() || MF.hasInlineAsm() || !findBlocks(MF) || Users.empty())
    return false;
  MachineBasicBlock *Save = findSave(MF);
  MachineBasicBlock *Restore = Save ? findRestore(MF, Save) : nullptr;
  if (!Restore)
    return false;
  MFI.setSavePoint(Save);
  MFI.setRestorePoint(Restore);
  return true;
}

char TraxShrinkWrap::ID = 0;

INITIALIZE_PASS_BEGIN(TraxShrinkWrap, DEBUG_TYPE, "TRaX places of saved registers", false, false)
INITIALIZE_PASS_DEPENDENCY(MachineBlockFrequencyInfoWrapperPass)
INITIALIZE_PASS_DEPENDENCY(MachineDominatorTreeWrapperPass)
INITIALIZE_PASS_END(TraxShrinkWrap, DEBUG_TYPE, "TRaX places of saved registers", false, false)

char &llvm::TraxShrinkWrapID = TraxShrinkWrap::ID;
