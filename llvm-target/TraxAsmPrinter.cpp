//===- TraxAsmPrinter.cpp - Functions to MC ------------------------------===//
#include "LLVMTrax.h"
#include "MCTargetDesc/TraxInstPrinter.h"
#include "MCTargetDesc/TraxTargetStreamer.h"
#include "TargetInfo/TraxTargetInfo.h"
#include "Trax.h"
#include "TraxMCInstLower.h"
#include "TraxSubtarget.h"
#include "TraxTargetMachine.h"
#include "llvm/CodeGen/AsmPrinter.h"
#include "llvm/CodeGen/MachineInstr.h"
#include "llvm/IR/DiagnosticInfo.h"
#include "llvm/IR/Module.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCExpr.h"
#include "llvm/MC/MCInst.h"
#include "llvm/MC/MCInstBuilder.h"
#include "llvm/MC/MCStreamer.h"
#include "llvm/MC/TargetRegistry.h"

using namespace llvm;

#define DEBUG_TYPE "asm-printer"

namespace {

class TraxAsmPrinter : public AsmPrinter {
public:
  TraxAsmPrinter(TargetMachine &TM, std::unique_ptr<MCStreamer> Streamer) : AsmPrinter(TM, std::move(Streamer)) {}

  StringRef getPassName() const override { return "TRaX assembly printer"; }

  void emitStartOfAsmFile(Module &M) override;
  void emitInstruction(const MachineInstr *MI) override;
  void emitEndOfAsmFile(Module &M) override;
  bool PrintAsmOperand(const MachineInstr *MI, unsigned OpNo, const char *ExtraCode, raw_ostream &OS) override;
  bool PrintAsmMemoryOperand(const MachineInstr *MI, unsigned OpNo, const char *ExtraCode, raw_ostream &OS) override;

  // Generated from the PseudoInstExpansions of TraxPseudos.td.
  bool emitPseudoExpansionLowering(MCStreamer &OutStreamer, const MachineInstr *MI);
  bool lowerOperand(const MachineOperand &MO, MCOperand &MCOp) { return lowerTraxOperand(MO, MCOp, *this); }

private:
  void emitJumpMarker();
};

} // namespace

#include "TraxGenMCPseudoLowering.inc"

/// Emits where the functions expect the stack, for the linker to compare.
void TraxAsmPrinter::emitStartOfAsmFile(Module &M) {
  auto &Streamer = static_cast<TraxTargetStreamer &>(*OutStreamer->getTargetStreamer());
  for (const Function &F : M)
    if (!F.isDeclarationForLinker() && !Streamer.setStack(TM.getSubtarget<TraxSubtarget>(F).getStack()))
      M.getContext().diagnose(DiagnosticInfoUnsupported(F, "the functions of one file expect the stack in one place"));
}

/// Marks the next jalr for the linker as a jump within the function, not a tail call.
void TraxAsmPrinter::emitJumpMarker() {
  MCSymbol *Place = OutContext.createTempSymbol();
  OutStreamer->emitLabel(Place);
  OutStreamer->emitRelocDirective(*MCSymbolRefExpr::create(Place, OutContext), "R_TRAX_JUMP", nullptr, SMLoc(),
                                  getSubtargetInfo());
}

void TraxAsmPrinter::emitInstruction(const MachineInstr *MI) {
  if (emitPseudoExpansionLowering(*OutStreamer, MI))
    return;
  MCInst Inst;
  MCOperand Callee;
  switch (MI->getOpcode()) {
  case Trax::PseudoCALL:
  case Trax::PseudoTAIL:
    lowerOperand(MI->getOperand(0), Callee);
    Inst =
        MCInstBuilder(Trax::JAL).addReg(MI->getOpcode() == Trax::PseudoCALL ? Trax::R1 : Trax::R0).addOperand(Callee);
    break;
  case Trax::PseudoTAILIndirect:
    Inst = MCInstBuilder(Trax::JALR).addReg(Trax::R0).addReg(MI->getOperand(0).getReg()).addImm(0);
    break;
  case Trax::PseudoSjLjSetup:
    return;
  case Trax::PseudoBRIND:
    emitJumpMarker();
    Inst = MCInstBuilder(Trax::JALR).addReg(Trax::R0).addReg(MI->getOperand(0).getReg());
    lowerOperand(MI->getOperand(1), Callee);
    Inst.addOperand(Callee);
    break;
  default:
    lowerTraxInstruction(*MI, Inst, *this);
  }
  EmitToStreamer(*OutStreamer, Inst);
}

/// If main uses argc or argv, the linker takes them from the library, for crt0 (docs/abi.md, "Program start").
void TraxAsmPrinter::emitEndOfAsmFile(Module &M) {
  const Function *Main = M.getFunction("main");
  if (Main && !Main->isDeclaration() && any_of(Main->args(), [](const Argument &A) { return !A.use_empty(); }))
    OutStreamer->emitSymbolAttribute(OutContext.getOrCreateSymbol("__trax_argv"), MCSA_Global);
}

/// An operand of inline assembly. %z prints r0 for the constant 0, %H the register of a double word's upper half.
bool TraxAsmPrinter::PrintAsmOperand(const MachineInstr *MI, unsigned OpNo, const char *ExtraCode, raw_ostream &OS) {
  const MachineOperand &MO = MI->getOperand(OpNo);
  if (ExtraCode && ExtraCode[0]) {
    if (ExtraCode[0] == 'H' && ExtraCode[1] == 0) {
      const InlineAsm::Flag Operand(MI->getOperand(OpNo - 1).getImm());
      if (!MO.isReg() || Operand.getNumOperandRegisters() != 2)
        return true;
      OS << TraxInstPrinter::getRegisterName(MI->getOperand(OpNo + 1).getReg());
      return false;
    }
    if (ExtraCode[0] == 'z' && ExtraCode[1] == 0 && MO.isImm() && MO.getImm() == 0) {
      OS << TraxInstPrinter::getRegisterName(Trax::R0);
      return false;
    }
    if (ExtraCode[0] != 'z' || ExtraCode[1] != 0)
      return AsmPrinter::PrintAsmOperand(MI, OpNo, ExtraCode, OS);
  }
  switch (MO.getType()) {
  case MachineOperand::MO_Immediate:
    OS << MO.getImm();
    return false;
  case MachineOperand::MO_Register:
    OS << TraxInstPrinter::getRegisterName(MO.getReg());
    return false;
  case MachineOperand::MO_GlobalAddress:
    PrintSymbolOperand(MO, OS);
    return false;
  case MachineOperand::MO_BlockAddress:
    GetBlockAddressSymbol(MO.getBlockAddress())->print(OS, MAI);
    return false;
  default:
    return true;
  }
}

bool TraxAsmPrinter::PrintAsmMemoryOperand(const MachineInstr *MI, unsigned OpNo, const char *ExtraCode,
                                           raw_ostream &OS) {
  const MachineOperand &Base = MI->getOperand(OpNo), &Offset = MI->getOperand(OpNo + 1);
  MCOperand MCOffset;
  if ((ExtraCode && ExtraCode[0]) || !Base.isReg() || !lowerOperand(Offset, MCOffset))
    return true;
  if (MCOffset.isExpr())
    MCOffset.getExpr()->print(OS, MAI);
  else
    OS << MCOffset.getImm();
  OS << '(' << TraxInstPrinter::getRegisterName(Base.getReg()) << ')';
  return false;
}

void LLVMInitializeTraxAsmPrinter() {
  RegisterAsmPrinter<TraxAsmPrinter> X(getTheTraxTarget());
}
