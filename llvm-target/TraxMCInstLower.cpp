//===- TraxMCInstLower.cpp - MachineInstr to MCInst ----------------------===//
#include "TraxMCInstLower.h"
#include "MCTargetDesc/TraxBaseInfo.h"
#include "MCTargetDesc/TraxMCExpr.h"
#include "MCTargetDesc/TraxMCTargetDesc.h"
#include "TraxInstrInfo.h"
#include "llvm/CodeGen/AsmPrinter.h"
#include "llvm/CodeGen/MachineBasicBlock.h"
#include "llvm/CodeGen/MachineInstr.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCInst.h"

using namespace llvm;

static MCOperand lowerSymbol(const MachineOperand &MO, MCSymbol *Symbol, AsmPrinter &AP) {
  MCContext &Ctx = AP.OutContext;
  const MCExpr *Expr = MCSymbolRefExpr::create(Symbol, Ctx);
  if (!MO.isJTI() && !MO.isMBB() && MO.getOffset() != 0)
    Expr = MCBinaryExpr::createAdd(Expr, MCConstantExpr::create(MO.getOffset(), Ctx), Ctx);
  switch (MO.getTargetFlags()) {
  case TraxII::MO_HI:
    Expr = TraxMCExpr::create(Expr, TraxMCExpr::S_HI, Ctx);
    break;
  case TraxII::MO_LO:
    Expr = TraxMCExpr::create(Expr, TraxMCExpr::S_LO, Ctx);
    break;
  case TraxII::MO_ABS:
    Expr = TraxMCExpr::create(Expr, TraxMCExpr::S_ABS, Ctx);
    break;
  default:
    break;
  }
  return MCOperand::createExpr(Expr);
}

/// An instruction names a group by its first register.
static MCRegister firstOfGroup(const MachineOperand &MO) {
  const MachineInstr *MI = MO.getParent();
  const TargetRegisterInfo &TRI = *MI->getMF()->getSubtarget().getRegisterInfo();
  const MCRegister First = TRI.getSubReg(MO.getReg(), Trax::group0);
  return First ? First : MO.getReg().asMCReg();
}

bool llvm::lowerTraxOperand(const MachineOperand &MO, MCOperand &MCOp, AsmPrinter &AP) {
  switch (MO.getType()) {
  case MachineOperand::MO_Register:
    if (MO.isImplicit())
      return false;
    MCOp = MCOperand::createReg(firstOfGroup(MO));
    return true;
  case MachineOperand::MO_Immediate:
    MCOp = MCOperand::createImm(MO.getImm());
    return true;
  case MachineOperand::MO_MachineBasicBlock:
    MCOp = lowerSymbol(MO, MO.getMBB()->getSymbol(), AP);
    return true;
  case MachineOperand::MO_GlobalAddress:
    MCOp = lowerSymbol(MO, AP.getSymbolPreferLocal(*MO.getGlobal()), AP);
    return true;
  case MachineOperand::MO_ExternalSymbol:
    MCOp = lowerSymbol(MO, AP.GetExternalSymbolSymbol(MO.getSymbolName()), AP);
    return true;
  case MachineOperand::MO_BlockAddress:
    MCOp = lowerSymbol(MO, AP.GetBlockAddressSymbol(MO.getBlockAddress()), AP);
    return true;
  case MachineOperand::MO_JumpTableIndex:
    MCOp = lowerSymbol(MO, AP.GetJTISymbol(MO.getIndex()), AP);
    return true;
  case MachineOperand::MO_ConstantPoolIndex:
    MCOp = lowerSymbol(MO, AP.GetCPISymbol(MO.getIndex()), AP);
    return true;
  case MachineOperand::MO_MCSymbol:
    MCOp = lowerSymbol(MO, MO.getMCSymbol(), AP);
    return true;
  default: // register masks, metadata
    return false;
  }
}

void llvm::lowerTraxInstruction(const MachineInstr &MI, MCInst &Inst, AsmPrinter &AP) {
  Inst.setOpcode(MI.getOpcode());
  for (const MachineOperand &MO : MI.operands()) {
    MCOperand MCOp;
    if (lowerTraxOperand(MO, MCOp, AP))
      Inst.addOperand(MCOp);
  }
}
