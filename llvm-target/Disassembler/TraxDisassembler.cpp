//===- TraxDisassembler.cpp - Bits to MCInst -----------------------------===//
#include "LLVMTrax.h"
#include "MCTargetDesc/TraxBaseInfo.h"
#include "MCTargetDesc/TraxMCTargetDesc.h"
#include "TargetInfo/TraxTargetInfo.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCDecoderOps.h"
#include "llvm/MC/MCDisassembler/MCDisassembler.h"
#include "llvm/MC/MCInst.h"
#include "llvm/MC/MCInstrInfo.h"
#include "llvm/MC/MCRegisterInfo.h"
#include "llvm/MC/MCSubtargetInfo.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Support/Endian.h"
#include "llvm/Support/MathExtras.h"

using namespace llvm;

#define DEBUG_TYPE "trax-disassembler"

using DecodeStatus = MCDisassembler::DecodeStatus;

namespace {

class TraxDisassembler : public MCDisassembler {
public:
  TraxDisassembler(const MCSubtargetInfo &STI, MCContext &Ctx) : MCDisassembler(STI, Ctx) {}

  DecodeStatus getInstruction(MCInst &Instr, uint64_t &Size, ArrayRef<uint8_t> Bytes, uint64_t Address,
                              raw_ostream &CStream) const override;
};

} // namespace

static DecodeStatus DecodeGPRRegisterClass(MCInst &Inst, uint64_t Number, uint64_t, const MCDisassembler *Decoder) {
  // By encoding, not by the class's allocation order.
  const MCRegisterInfo &MRI = *Decoder->getContext().getRegisterInfo();
  for (MCPhysReg Reg : MRI.getRegClass(Trax::GPRRegClassID))
    if (MRI.getEncodingValue(Reg) == Number) {
      Inst.addOperand(MCOperand::createReg(Reg));
      return MCDisassembler::Success;
    }
  return MCDisassembler::Fail;
}

static DecodeStatus decodeSImm16(MCInst &Inst, uint64_t Field, uint64_t, const MCDisassembler *) {
  Inst.addOperand(MCOperand::createImm(SignExtend64<16>(Field)));
  return MCDisassembler::Success;
}

static DecodeStatus decodeBrTarget(MCInst &Inst, uint64_t Field, uint64_t, const MCDisassembler *) {
  Inst.addOperand(MCOperand::createImm(SignExtend64<16>(Field) * 4));
  return MCDisassembler::Success;
}

static DecodeStatus decodeJalTarget(MCInst &Inst, uint64_t Field, uint64_t, const MCDisassembler *) {
  Inst.addOperand(MCOperand::createImm(SignExtend64<21>(Field) * 4));
  return MCDisassembler::Success;
}

/// An instruction with an unassigned number is illegal.
static DecodeStatus decodeAssigned(MCInst &Inst, uint64_t Field, StringRef Name) {
  if (Name.empty())
    return MCDisassembler::Fail;
  Inst.addOperand(MCOperand::createImm(Field));
  return MCDisassembler::Success;
}

static DecodeStatus decodeSpecialRegister(MCInst &Inst, uint64_t Field, uint64_t, const MCDisassembler *) {
  return decodeAssigned(Inst, Field, TraxII::getSpecialRegisterName(Field));
}

static DecodeStatus decodeTrapCode(MCInst &Inst, uint64_t Field, uint64_t, const MCDisassembler *) {
  return decodeAssigned(Inst, Field, TraxII::getTrapName(Field));
}

static DecodeStatus decodeFenceKind(MCInst &Inst, uint64_t Field, uint64_t, const MCDisassembler *) {
  return decodeAssigned(Inst, Field, TraxII::getFenceName(Field));
}

#include "TraxGenDisassemblerTables.inc"

DecodeStatus TraxDisassembler::getInstruction(MCInst &Instr, uint64_t &Size, ArrayRef<uint8_t> Bytes, uint64_t Address,
                                              raw_ostream &) const {
  if (Bytes.size() < 4) {
    Size = Bytes.size();
    return MCDisassembler::Fail;
  }
  Size = 4;
  return decodeInstruction(DecoderTableTrax32, Instr, support::endian::read32le(Bytes.data()), Address, this, STI);
}

static MCDisassembler *createTraxDisassembler(const Target &, const MCSubtargetInfo &STI, MCContext &Ctx) {
  return new TraxDisassembler(STI, Ctx);
}

void LLVMInitializeTraxDisassembler() {
  TargetRegistry::RegisterMCDisassembler(getTheTraxTarget(), createTraxDisassembler);
}
