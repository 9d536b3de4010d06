//===- Decoder.h - LLVM's disassembler for the target, with its parts ----===//
#ifndef TRAX_TOOLS_DECODER_H
#define TRAX_TOOLS_DECODER_H

#include "llvm/MC/MCAsmInfo.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCDisassembler/MCDisassembler.h"
#include "llvm/MC/MCInst.h"
#include "llvm/MC/MCInstPrinter.h"
#include "llvm/MC/MCInstrInfo.h"
#include "llvm/MC/MCRegisterInfo.h"
#include "llvm/MC/MCSubtargetInfo.h"
#include "llvm/MC/MCTargetOptions.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/TargetParser/Triple.h"
#include <memory>

namespace trax {

/// Decodes words and prints instructions. The users encode and analyse them with the same parts.
struct Decoder {
  llvm::Triple TT{"trax"};
  llvm::MCTargetOptions Options;
  std::unique_ptr<llvm::MCRegisterInfo> MRI;
  std::unique_ptr<llvm::MCAsmInfo> MAI;
  std::unique_ptr<llvm::MCInstrInfo> MII;
  std::unique_ptr<llvm::MCSubtargetInfo> STI;
  std::unique_ptr<llvm::MCContext> Ctx;
  std::unique_ptr<llvm::MCDisassembler> Disassembler;
  std::unique_ptr<llvm::MCInstPrinter> Printer, PlainPrinter; ///< the latter without aliases

  explicit Decoder(const llvm::Target &T)
      : MRI(T.createMCRegInfo(TT.str())), MAI(T.createMCAsmInfo(*MRI, TT.str(), Options)), MII(T.createMCInstrInfo()),
        STI(T.createMCSubtargetInfo(TT.str(), "", "")),
        Ctx(std::make_unique<llvm::MCContext>(TT, MAI.get(), MRI.get(), STI.get())),
        Disassembler(T.createMCDisassembler(*STI, *Ctx)) {
    for (std::unique_ptr<llvm::MCInstPrinter> *P : {&Printer, &PlainPrinter}) {
      P->reset(T.createMCInstPrinter(TT, 0, *MAI, *MII, *MRI));
      (*P)->setPrintBranchImmAsAddress(true);
      (*P)->setPrintImmHex(false);
    }
    PlainPrinter->applyTargetSpecificCLOption("no-aliases");
  }

  /// Whether the bytes begin with an instruction, which becomes Inst.
  bool decode(llvm::MCInst &Inst, llvm::ArrayRef<uint8_t> Bytes, uint64_t Address) const {
    uint64_t Size;
    return Disassembler->getInstruction(Inst, Size, Bytes, Address, llvm::nulls()) == llvm::MCDisassembler::Success;
  }
};

} // namespace trax

#endif
