//===- TraxInstPrinter.h - MCInst to assembly ----------------------------===//
#ifndef TRAX_MCTARGETDESC_TRAXINSTPRINTER_H
#define TRAX_MCTARGETDESC_TRAXINSTPRINTER_H

#include "llvm/MC/MCInstPrinter.h"

namespace llvm {

class TraxInstPrinter : public MCInstPrinter {
public:
  TraxInstPrinter(const MCAsmInfo &MAI, const MCInstrInfo &MII, const MCRegisterInfo &MRI)
      : MCInstPrinter(MAI, MII, MRI) {}

  /// "no-aliases" prints every instruction under its own mnemonic.
  bool applyTargetSpecificCLOption(StringRef Opt) override;
  void printInst(const MCInst *MI, uint64_t Address, StringRef Annot, const MCSubtargetInfo &STI,
                 raw_ostream &O) override;
  void printRegName(raw_ostream &O, MCRegister Reg) const override;

  void printOperand(const MCInst *MI, unsigned OpNo, const MCSubtargetInfo &STI, raw_ostream &O);
  void printPCRelOperand(const MCInst *MI, uint64_t Address, unsigned OpNo, const MCSubtargetInfo &STI, raw_ostream &O);
  void printFenceKind(const MCInst *MI, unsigned OpNo, const MCSubtargetInfo &STI, raw_ostream &O);
  void printSpecialRegister(const MCInst *MI, unsigned OpNo, const MCSubtargetInfo &STI, raw_ostream &O);
  void printTrapCode(const MCInst *MI, unsigned OpNo, const MCSubtargetInfo &STI, raw_ostream &O);

  // Generated from the instruction tables.
  std::pair<const char *, uint64_t> getMnemonic(const MCInst *MI) override;
  void printInstruction(const MCInst *MI, uint64_t Address, const MCSubtargetInfo &STI, raw_ostream &O);
  bool printAliasInstr(const MCInst *MI, uint64_t Address, const MCSubtargetInfo &STI, raw_ostream &O);
  void printCustomAliasOperand(const MCInst *MI, uint64_t Address, unsigned OpIdx, unsigned PrintMethodIdx,
                               const MCSubtargetInfo &STI, raw_ostream &O);
  static const char *getRegisterName(MCRegister Reg);
};

} // namespace llvm

#endif
