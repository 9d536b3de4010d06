//===- TraxCallLowering.cpp - Arguments, results and calls ---------------===//
#include "MCTargetDesc/TraxInstPrinter.h"
#include "Trax.h"
#include "TraxBuiltins.h"
#include "TraxISelLowering.h"
#include "TraxMachineFunctionInfo.h"
#include "TraxSubtarget.h"
#include "trax/abi.h"
#include "llvm/CodeGen/CallingConvLower.h"
#include "llvm/CodeGen/MachineFrameInfo.h"
#include "llvm/CodeGen/MachineRegisterInfo.h"
#include "llvm/IR/DiagnosticInfo.h"

using namespace llvm;

#include "TraxGenCallingConv.inc"

static void unsupported(SelectionDAG &DAG, const SDLoc &DL, const Twine &What) {
  const Function &F = DAG.getMachineFunction().getFunction();
  DAG.getContext()->diagnose(DiagnosticInfoUnsupported(F, What, DL.getDebugLoc()));
}

/// The ABI fixes the registers of arguments and results, so -ffixed-rN must not name one of them.
static void checkReserved(ArrayRef<CCValAssign> Locations, const SDLoc &DL, SelectionDAG &DAG) {
  for (const CCValAssign &VA : Locations)
    if (VA.isRegLoc() && DAG.getSubtarget<TraxSubtarget>().isReserved(VA.getLocReg()))
      unsupported(DAG, DL,
                  Twine(TraxInstPrinter::getRegisterName(VA.getLocReg())) +
                      " is needed for an argument or a result, and -ffixed-rN keeps it free");
}

static void checkCallingConv(CallingConv::ID CC, const SDLoc &DL, SelectionDAG &DAG) {
  if (CC != CallingConv::C && CC != CallingConv::Fast && CC != CallingConv::Cold)
    unsupported(DAG, DL, "unsupported calling convention");
}

//--- this function's arguments and results ------------------------------------

SDValue TraxTargetLowering::LowerFormalArguments(SDValue Chain, CallingConv::ID CC, bool IsVarArg,
                                                 const SmallVectorImpl<ISD::InputArg> &Ins, const SDLoc &DL,
                                                 SelectionDAG &DAG, SmallVectorImpl<SDValue> &InVals) const {
  checkCallingConv(CC, DL, DAG);
  MachineFunction &MF = DAG.getMachineFunction();
  MachineFrameInfo &MFI = MF.getFrameInfo();
  MachineRegisterInfo &MRI = MF.getRegInfo();

  SmallVector<CCValAssign, 16> Locations;
  CCState Info(CC, IsVarArg, MF, Locations, *DAG.getContext());
  Info.AnalyzeFormalArguments(Ins, CC_Trax);
  checkReserved(Locations, DL, DAG);

  for (const auto &[VA, In] : zip_equal(Locations, Ins)) {
    if (VA.isRegLoc()) {
      Register VReg = MRI.createVirtualRegister(&Trax::GPRRegClass);
      MRI.addLiveIn(VA.getLocReg(), VReg);
      InVals.push_back(DAG.getCopyFromReg(Chain, DL, VReg, VA.getLocVT()));
      continue;
    }
    bool IsByVal = In.Flags.isByVal();
    unsigned Size = IsByVal ? std::max(1u, In.Flags.getByValSize()) : 4;
    // A copy of an aggregate belongs to this function, which may write it.
    int FI = MFI.CreateFixedObject(Size, VA.getLocMemOffset(), /*IsImmutable=*/!IsByVal);
    SDValue Address = DAG.getFrameIndex(FI, MVT::i32);
    InVals.push_back(
        IsByVal ? Address : DAG.getLoad(VA.getLocVT(), DL, Chain, Address, MachinePointerInfo::getFixedStack(MF, FI)));
  }
  if (IsVarArg)
    MF.getInfo<TraxMachineFunctionInfo>()->setVarArgsFrameIndex(
        MFI.CreateFixedObject(4, Info.getStackSize(), /*IsImmutable=*/true));
  return Chain;
}

bool TraxTargetLowering::CanLowerReturn(CallingConv::ID CC, MachineFunction &MF, bool IsVarArg,
                                        const SmallVectorImpl<ISD::OutputArg> &Outs, LLVMContext &Context) const {
  SmallVector<CCValAssign, 4> Locations;
  CCState Info(CC, IsVarArg, MF, Locations, Context);
  return Info.CheckReturn(Outs, RetCC_Trax);
}

SDValue TraxTargetLowering::LowerReturn(SDValue Chain, CallingConv::ID CC, bool IsVarArg,
                                        const SmallVectorImpl<ISD::OutputArg> &Outs,
                                        const SmallVectorImpl<SDValue> &OutVals, const SDLoc &DL,
                                        SelectionDAG &DAG) const {
  SmallVector<CCValAssign, 4> Locations;
  CCState Info(CC, IsVarArg, DAG.getMachineFunction(), Locations, *DAG.getContext());
  Info.AnalyzeReturn(Outs, RetCC_Trax);
  checkReserved(Locations, DL, DAG);

  SDValue Glue;
  SmallVector<SDValue, 6> Operands(1, Chain);
  for (const auto &[VA, Value] : zip_equal(Locations, OutVals)) {
    Chain = DAG.getCopyToReg(Chain, DL, VA.getLocReg(), Value, Glue);
    Glue = Chain.getValue(1);
    Operands.push_back(DAG.getRegister(VA.getLocReg(), VA.getLocVT()));
  }
  Operands[0] = Chain;
  if (Glue)
    Operands.push_back(Glue);
  return DAG.getNode(TraxISD::RET, DL, MVT::Other, Operands);
}

//--- calls --------------------------------------------------------------------

/// Named arguments go to registers first, unnamed ones to the stack.
static void assignArguments(CCState &Info, const SmallVectorImpl<ISD::OutputArg> &Outs) {
  for (const auto &[Index, Out] : enumerate(Outs)) {
    CCAssignFn *Assign = Out.IsFixed ? CC_Trax : CC_Trax_Unnamed;
    bool Failed = Assign(Index, Out.VT, Out.VT, CCValAssign::Full, Out.Flags, Info);
    assert(!Failed && "the stack takes what registers do not");
    (void)Failed;
  }
}

/// A tail call needs no stack: neither for arguments nor for anything of this frame that the callee would read.
bool TraxTargetLowering::isTailCallPossible(const CallLoweringInfo &CLI, const CCState &Info) const {
  const Function &Caller = CLI.DAG.getMachineFunction().getFunction();
  if (Info.getStackSize() != 0 || Caller.hasStructRetAttr() || (!CLI.Outs.empty() && CLI.Outs[0].Flags.isSRet()))
    return false;
  return none_of(CLI.Outs, [](const ISD::OutputArg &Out) { return Out.Flags.isByVal(); });
}

/// Copies an aggregate to its place among the arguments. A call of memcpy is not possible within a call's sequence, so
/// a loop copies a long one.
static SDValue copyArgument(SDValue Chain, const SDLoc &DL, SDValue To, SDValue From, ISD::ArgFlagsTy Flags,
                            MachinePointerInfo Where, SelectionDAG &DAG) {
  constexpr unsigned LongestInline = 64;
  const Align Alignment = std::min(Align(4), Flags.getNonZeroByValAlign());
  const unsigned Unit = Alignment == Align(4) ? 4 : 1, Size = Flags.getByValSize();
  unsigned InLoop = 0;
  if (Size > LongestInline) {
    InLoop = Size - Size % (4 * Unit);
    Chain = DAG.getNode(
        TraxISD::COPY_LOOP, DL, MVT::Other,
        {Chain, To, From, DAG.getTargetConstant(InLoop, DL, MVT::i32), DAG.getTargetConstant(Unit, DL, MVT::i32)});
    if (InLoop == Size)
      return Chain;
    To = DAG.getMemBasePlusOffset(To, TypeSize::getFixed(InLoop), DL);
    From = DAG.getMemBasePlusOffset(From, TypeSize::getFixed(InLoop), DL);
  }
  return DAG.getMemcpy(Chain, DL, To, From, DAG.getConstant(Size - InLoop, DL, MVT::i32), Alignment, /*isVol=*/false,
                       /*AlwaysInline=*/true, /*CI=*/nullptr, std::nullopt, Where.getWithOffset(InLoop),
                       MachinePointerInfo());
}

/// PseudoCopyLoop to, from, bytes, unit: copies four units an iteration. bytes is a positive multiple of that.
MachineBasicBlock *TraxTargetLowering::emitCopyLoop(MachineInstr &MI, MachineBasicBlock *This) const {
  MachineFunction &MF = *This->getParent();
  MachineRegisterInfo &MRI = MF.getRegInfo();
  const TargetInstrInfo &TII = *MF.getSubtarget().getInstrInfo();
  const DebugLoc DL = MI.getDebugLoc();
  const Register FirstTo = MI.getOperand(0).getReg(), FirstFrom = MI.getOperand(1).getReg();
  const int64_t Bytes = MI.getOperand(2).getImm(), Unit = MI.getOperand(3).getImm();
  auto NewRegister = [&] { return MRI.createVirtualRegister(&Trax::GPRRegClass); };

  MachineBasicBlock *Loop = MF.CreateMachineBasicBlock(This->getBasicBlock());
  MachineBasicBlock *Rest = MF.CreateMachineBasicBlock(This->getBasicBlock());
  MF.insert(std::next(This->getIterator()), Loop);
  MF.insert(std::next(Loop->getIterator()), Rest);
  const unsigned CallFrameSize = TII.getCallFrameSizeAt(MI);
  Loop->setCallFrameSize(CallFrameSize);
  Rest->setCallFrameSize(CallFrameSize);
  Rest->splice(Rest->begin(), This, std::next(MI.getIterator()), This->end());
  Rest->transferSuccessorsAndUpdatePHIs(This);
  This->addSuccessor(Loop);
  Loop->addSuccessor(Loop);
  Loop->addSuccessor(Rest);

  const Register End = NewRegister();
  if (isInt<16>(Bytes)) {
    BuildMI(This, DL, TII.get(Trax::ADDI), End).addReg(FirstFrom).addImm(Bytes);
  } else {
    const Register Upper = NewRegister(), Size = NewRegister();
    BuildMI(This, DL, TII.get(Trax::LUI), Upper).addImm((Bytes + 0x8000) >> 16 & 0xFFFF);
    BuildMI(This, DL, TII.get(Trax::ADDI), Size).addReg(Upper).addImm(SignExtend64<16>(Bytes));
    BuildMI(This, DL, TII.get(Trax::ADD), End).addReg(FirstFrom).addReg(Size);
  }
  const Register To = NewRegister(), From = NewRegister(), NextTo = NewRegister(), NextFrom = NewRegister();
  BuildMI(Loop, DL, TII.get(TargetOpcode::PHI), To).addReg(FirstTo).addMBB(This).addReg(NextTo).addMBB(Loop);
  BuildMI(Loop, DL, TII.get(TargetOpcode::PHI), From).addReg(FirstFrom).addMBB(This).addReg(NextFrom).addMBB(Loop);
  Register Values[4];
  for (int I = 0; I < 4; ++I)
    BuildMI(Loop, DL, TII.get(Unit == 4 ? Trax::LW : Trax::LBU), Values[I] = NewRegister())
        .addReg(From)
        .addImm(I * Unit);
  for (int I = 0; I < 4; ++I)
    BuildMI(Loop, DL, TII.get(Unit == 4 ? Trax::SW : Trax::SB)).addReg(Values[I]).addReg(To).addImm(I * Unit);
  BuildMI(Loop, DL, TII.get(Trax::ADDI), NextTo).addReg(To).addImm(4 * Unit);
  BuildMI(Loop, DL, TII.get(Trax::ADDI), NextFrom).addReg(From).addImm(4 * Unit);
  BuildMI(Loop, DL, TII.get(Trax::BNE)).addReg(NextFrom).addReg(End).addMBB(Loop);
  MI.eraseFromParent();
  return Rest;
}

MachineBasicBlock *TraxTargetLowering::EmitInstrWithCustomInserter(MachineInstr &MI, MachineBasicBlock *MBB) const {
  return MI.getOpcode() == Trax::PseudoSETJMP ? emitSetJmp(MI, MBB) : emitCopyLoop(MI, MBB);
}

SDValue TraxTargetLowering::LowerCall(CallLoweringInfo &CLI, SmallVectorImpl<SDValue> &InVals) const {
  if (SDValue Chain = lowerBuiltinCall(CLI, InVals))
    return Chain;

  SelectionDAG &DAG = CLI.DAG;
  SDLoc &DL = CLI.DL;
  SDValue Chain = CLI.Chain;
  MachineFunction &MF = DAG.getMachineFunction();
  MachineFrameInfo &MFI = MF.getFrameInfo();
  checkCallingConv(CLI.CallConv, DL, DAG);

  // An unnamed aggregate that is passed in memory is passed by the address of a copy: a va_list then holds a pointer.
  SmallVector<ISD::OutputArg, 16> Outs(CLI.Outs.begin(), CLI.Outs.end());
  SmallVector<SDValue, 16> OutVals(CLI.OutVals.begin(), CLI.OutVals.end());
  bool CopiesToFrame = false;
  for (const auto &[Out, Value] : zip_equal(Outs, OutVals)) {
    if (!Out.Flags.isByVal())
      continue;
    unsigned Size = Out.Flags.getByValSize();
    if (Size > TRAX_LOCAL_SIZE && Subtarget.getStack() != TRAX_EF_STACK_GLOBAL) {
      unsupported(DAG, DL,
                  "an argument of " + Twine(Size) +
                      " bytes does not fit the local memory; -mstack=global has room for it");
      Out.Flags.setByValSize(4);
      Size = 4;
    }
    if (Out.IsFixed)
      continue;
    Align Alignment = std::max(Align(4), Out.Flags.getNonZeroByValAlign());
    int FI = MFI.CreateStackObject(std::max(4u, Size), Alignment, /*isSpillSlot=*/false);
    SDValue Copy = DAG.getFrameIndex(FI, MVT::i32);
    Chain = copyArgument(Chain, DL, Copy, Value, Out.Flags, MachinePointerInfo::getFixedStack(MF, FI), DAG);
    Value = Copy;
    Out.Flags = ISD::ArgFlagsTy();
    CopiesToFrame = true;
  }

  SmallVector<CCValAssign, 16> Locations;
  CCState Info(CLI.CallConv, CLI.IsVarArg, MF, Locations, *DAG.getContext());
  assignArguments(Info, Outs);
  checkReserved(Locations, DL, DAG);
  if (CLI.IsTailCall)
    CLI.IsTailCall = !CopiesToFrame && isTailCallPossible(CLI, Info);
  if (!CLI.IsTailCall && CLI.CB && CLI.CB->isMustTailCall())
    unsupported(DAG, DL, "this call cannot be a tail call: arguments or result need the stack");

  unsigned StackSize = Info.getStackSize();
  if (!CLI.IsTailCall)
    Chain = DAG.getCALLSEQ_START(Chain, StackSize, 0, DL);

  SmallVector<std::pair<Register, SDValue>, 8> Registers;
  SmallVector<SDValue, 8> Stores;
  SDValue StackPointer;
  for (const auto &[VA, Out, Value] : zip_equal(Locations, Outs, OutVals)) {
    if (VA.isRegLoc()) {
      Registers.emplace_back(VA.getLocReg(), Value);
      continue;
    }
    if (!StackPointer)
      StackPointer = DAG.getCopyFromReg(Chain, DL, Trax::R2, MVT::i32);
    SDValue Address =
        DAG.getNode(ISD::ADD, DL, MVT::i32, StackPointer, DAG.getConstant(VA.getLocMemOffset(), DL, MVT::i32));
    MachinePointerInfo Where = MachinePointerInfo::getStack(MF, VA.getLocMemOffset());
    if (Out.Flags.isByVal())
      Stores.push_back(copyArgument(Chain, DL, Address, Value, Out.Flags, Where, DAG));
    else
      Stores.push_back(DAG.getStore(Chain, DL, Value, Address, Where));
  }
  if (!Stores.empty())
    Chain = DAG.getNode(ISD::TokenFactor, DL, MVT::Other, Stores);

  SDValue Glue;
  for (const auto &[Reg, Value] : Registers) {
    Chain = DAG.getCopyToReg(Chain, DL, Reg, Value, Glue);
    Glue = Chain.getValue(1);
  }

  SDValue Callee = CLI.Callee;
  if (auto *Global = dyn_cast<GlobalAddressSDNode>(Callee))
    Callee = DAG.getTargetGlobalAddress(Global->getGlobal(), DL, MVT::i32, Global->getOffset());
  else if (auto *External = dyn_cast<ExternalSymbolSDNode>(Callee))
    Callee = DAG.getTargetExternalSymbol(External->getSymbol(), MVT::i32);

  SmallVector<SDValue, 12> Operands = {Chain, Callee};
  for (const auto &[Reg, Value] : Registers)
    Operands.push_back(DAG.getRegister(Reg, Value.getValueType()));
  const uint32_t *Preserved = Subtarget.getRegisterInfo()->getCallPreservedMask(MF, CLI.CallConv);
  Operands.push_back(DAG.getRegisterMask(Preserved));
  if (Glue)
    Operands.push_back(Glue);

  SDVTList NodeTypes = DAG.getVTList(MVT::Other, MVT::Glue);
  if (CLI.IsTailCall) {
    MFI.setHasTailCall();
    SDValue Tail = DAG.getNode(TraxISD::TAIL, DL, NodeTypes, Operands);
    DAG.addNoMergeSiteInfo(Tail.getNode(), CLI.NoMerge);
    return Tail;
  }
  Chain = DAG.getNode(TraxISD::CALL, DL, NodeTypes, Operands);
  DAG.addNoMergeSiteInfo(Chain.getNode(), CLI.NoMerge);
  Glue = Chain.getValue(1);
  Chain = DAG.getCALLSEQ_END(Chain, StackSize, 0, Glue, DL);
  Glue = Chain.getValue(1);

  SmallVector<CCValAssign, 4> Results;
  CCState ResultInfo(CLI.CallConv, CLI.IsVarArg, MF, Results, *DAG.getContext());
  ResultInfo.AnalyzeCallResult(CLI.Ins, RetCC_Trax);
  checkReserved(Results, DL, DAG);
  for (const CCValAssign &VA : Results) {
    SDValue Result = DAG.getCopyFromReg(Chain, DL, VA.getLocReg(), VA.getLocVT(), Glue);
    Chain = Result.getValue(1);
    Glue = Result.getValue(2);
    InVals.push_back(Result);
  }
  return Chain;
}

//--- builtins -----------------------------------------------------------------

/// The chain after a builtin's operation, or none if the callee is no builtin.
SDValue TraxTargetLowering::lowerBuiltinCall(CallLoweringInfo &CLI, SmallVectorImpl<SDValue> &InVals) const {
  auto *Callee = dyn_cast<GlobalAddressSDNode>(CLI.Callee);
  if (!Callee || Callee->getOffset() != 0 || !isa<Function>(Callee->getGlobal()))
    return SDValue();
  std::optional<TraxBuiltin::ID> Builtin = TraxBuiltin::find(Callee->getGlobal()->getName());
  if (!Builtin)
    return SDValue();

  // A function with this name and another type is the user's.
  const TraxBuiltin::Signature Signature = TraxBuiltin::signature(*Builtin);
  auto HasTypes = [](const auto &Values, ArrayRef<MVT> Types) {
    return Values.size() == Types.size() &&
           all_of(zip(Values, Types), [](auto P) { return std::get<0>(P).VT == std::get<1>(P); });
  };
  if (!HasTypes(CLI.Outs, Signature.Arguments) || !HasTypes(CLI.Ins, Signature.Results))
    return SDValue();
  SelectionDAG &DAG = CLI.DAG;
  const SDLoc &DL = CLI.DL;
  SDVTList WordAndChain = DAG.getVTList(MVT::i32, MVT::Other);
  auto Constant = [&](unsigned Index, unsigned Count, const Twine &What) -> std::optional<unsigned> {
    auto *C = dyn_cast<ConstantSDNode>(CLI.OutVals[Index]);
    if (C && C->getZExtValue() < Count)
      return C->getZExtValue();
    unsupported(DAG, DL, What + " must be a constant below " + Twine(Count));
    return std::nullopt;
  };
  SDValue Chain = CLI.Chain;
  [[maybe_unused]] auto LowerGroups = [&](unsigned Opcode) {
    SmallVector<SDValue, 20> Operands = {DAG.getTargetConstant(Opcode, DL, MVT::i32)};
    append_range(Operands, CLI.OutVals);
    InVals.push_back(DAG.getNode(TraxISD::GROUPS, DL, Signature.Results[0], Operands));
  };
  switch (*Builtin) {
#define BUILTIN(ID, NAME, TYPE, ATTRIBUTES)
#define GROUPS(ID, NAME, TYPE, INSTRUCTION)                                                                            \
  case TraxBuiltin::ID:                                                                                                \
    LowerGroups(Trax::INSTRUCTION##OfGroups);                                                                          \
    break;
#include "TraxBuiltins.def"
  case TraxBuiltin::Rsqrt:
    InVals.push_back(DAG.getNode(TraxISD::RSQRT, DL, MVT::f32, CLI.OutVals[0]));
    break;
  case TraxBuiltin::Opaque:
    InVals.push_back(DAG.getNode(TraxISD::OPAQUE, DL, MVT::i32, CLI.OutVals[0]));
    break;
  case TraxBuiltin::Rdsr: {
    SDValue Number = DAG.getTargetConstant(Constant(0, TRAX_SR_COUNT, "special register").value_or(0), DL, MVT::i32);
    if (Number->getAsZExtVal() <= TRAX_SR_THREADS) {
      InVals.push_back(DAG.getNode(TraxISD::RDSR_CONST, DL, MVT::i32, Number));
      break;
    }
    SDValue Read = DAG.getNode(TraxISD::RDSR, DL, WordAndChain, Chain, Number);
    InVals.push_back(Read);
    Chain = Read.getValue(1);
    break;
  }
  case TraxBuiltin::Trap: {
    SDValue Code = DAG.getTargetConstant(Constant(1, TRAX_TRAP_COUNT, "trap code").value_or(0), DL, MVT::i32);
    Chain = DAG.getNode(TraxISD::TRAP, DL, MVT::Other, Chain, CLI.OutVals[0], Code);
    break;
  }
  case TraxBuiltin::Halt:
    Chain = DAG.getNode(TraxISD::HALT, DL, MVT::Other, Chain);
    break;
  case TraxBuiltin::Ainc: {
    const Value *Pointer = CLI.CB ? CLI.CB->getArgOperand(0) : nullptr;
    MachineMemOperand *Word = DAG.getMachineFunction().getMachineMemOperand(
        Pointer ? MachinePointerInfo(Pointer) : MachinePointerInfo(),
        MachineMemOperand::MOVolatile | MachineMemOperand::MOLoad | MachineMemOperand::MOStore, 4, Align(4));
    SDValue Old = DAG.getMemIntrinsicNode(TraxISD::AINC, DL, WordAndChain, {Chain, CLI.OutVals[0]}, MVT::i32, Word);
    InVals.push_back(Old);
    Chain = Old.getValue(1);
    break;
  }
  }
  CLI.IsTailCall = false;
  return Chain;
}
