//===- TraxInstPrinter.cpp - MCInst to assembly --------------------------===//
#include "TraxInstPrinter.h"
#include "TraxBaseInfo.h"
#include "TraxMCTargetDesc.h"
#include "llvm/MC/MCExpr.h"
#include "llvm/MC/MCInst.h"
#include "llvm/MC/MCInstrInfo.h"
#include "llvm/MC/MCSubtargetInfo.h"
#include "llvm/Support/raw_ostream.h"

using namespace llvm;

#define DEBUG_TYPE "asm-printer"

#define PRINT_ALIAS_INSTR
#include "TraxGenAsmWriter.inc"

bool TraxInstPrinter::applyTargetSpecificCLOption(StringRef Opt) {
  if (Opt != "no-aliases")
    return false;
  PrintAliases = false;
  return true;
}

void TraxInstPrinter::printInst(const MCInst *MI, uint64_t Address, StringRef Annot, const MCSubtargetInfo &STI,
                                raw_ostream &O) {
  if (!PrintAliases || !printAliasInstr(MI, Address, STI, O))
    printInstruction(MI, Address, STI, O);
  printAnnotation(O, Annot);
}

void TraxInstPrinter::printRegName(raw_ostream &O, MCRegister Reg) const {
  O << getRegisterName(Reg);
}

void TraxInstPrinter::printOperand(const MCInst *MI, unsigned OpNo, const MCSubtargetInfo &, raw_ostream &O) {
  const MCOperand &MO = MI->getOperand(OpNo);
  if (MO.isReg())
    printRegName(O, MO.getReg());
  else if (MO.isImm())
    O << formatImm(MO.getImm());
  else
    MO.getExpr()->print(O, &MAI);
}

void TraxInstPrinter::printPCRelOperand(const MCInst *MI, uint64_t Address, unsigned OpNo, const MCSubtargetInfo &STI,
                                        raw_ostream &O) {
  const MCOperand &MO = MI->getOperand(OpNo);
  if (MO.isImm() && PrintBranchImmAsAddress)
    O << formatHex(uint64_t(uint32_t(Address + MO.getImm())));
  else
    printOperand(MI, OpNo, STI, O);
}

static void printNamed(StringRef Name, const MCOperand &MO, raw_ostream &O) {
  if (Name.empty())
    O << MO.getImm();
  else
    O << Name;
}

void TraxInstPrinter::printSpecialRegister(const MCInst *MI, unsigned OpNo, const MCSubtargetInfo &, raw_ostream &O) {
  const MCOperand &MO = MI->getOperand(OpNo);
  printNamed(TraxII::getSpecialRegisterName(MO.getImm()), MO, O);
}

void TraxInstPrinter::printTrapCode(const MCInst *MI, unsigned OpNo, const MCSubtargetInfo &, raw_ostream &O) {
  const MCOperand &MO = MI->getOperand(OpNo);
  printNamed(TraxII::getTrapName(MO.getImm()), MO, O);
}

void TraxInstPrinter::printFenceKind(const MCInst *MI, unsigned OpNo, const MCSubtargetInfo &, raw_ostream &O) {
  const MCOperand &MO = MI->getOperand(OpNo);
  printNamed(TraxII::getFenceName(MO.getImm()), MO, O);
}
