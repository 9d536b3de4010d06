//===- disassembly_test.cpp - LLVM's tables against the C tables ---------===//
//
// Both are generated from isa/TraxInstructions.td by different generators. For random words, and for random operands of
// every instruction: the same words are legal, they read the same, and encoding what was decoded gives the word back.
//
//===----------------------------------------------------------------------===//
#include "LLVMTrax.h"
#include "trax/abi.h"
#include "trax/isa.h"
#include "llvm/MC/MCAsmInfo.h"
#include "llvm/MC/MCCodeEmitter.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCDisassembler/MCDisassembler.h"
#include "llvm/MC/MCFixup.h"
#include "llvm/MC/MCInst.h"
#include "llvm/MC/MCInstPrinter.h"
#include "llvm/MC/MCInstrInfo.h"
#include "llvm/MC/MCRegisterInfo.h"
#include "llvm/MC/MCSubtargetInfo.h"
#include "llvm/MC/MCTargetOptions.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Support/Endian.h"
#include "llvm/Support/raw_ostream.h"
#include "llvm/TargetParser/Triple.h"
#include <random>

using namespace llvm;

namespace {

constexpr unsigned RandomWords = 1u << 21;
constexpr unsigned WordsPerInstruction = 1u << 14;
constexpr uint64_t Address = 0x00400000;

class Comparison {
  Triple TT{"trax"};
  MCTargetOptions Options;
  std::unique_ptr<MCRegisterInfo> MRI;
  std::unique_ptr<MCAsmInfo> MAI;
  std::unique_ptr<MCInstrInfo> MII;
  std::unique_ptr<MCSubtargetInfo> STI;
  std::unique_ptr<MCContext> Ctx;
  std::unique_ptr<MCDisassembler> Decoder;
  std::unique_ptr<MCCodeEmitter> Encoder;
  std::unique_ptr<MCInstPrinter> Printer;

public:
  uint64_t Legal = 0, Illegal = 0, Differences = 0;

  explicit Comparison(const Target &T) {
    MRI.reset(T.createMCRegInfo(TT.str()));
    MAI.reset(T.createMCAsmInfo(*MRI, TT.str(), Options));
    MII.reset(T.createMCInstrInfo());
    STI.reset(T.createMCSubtargetInfo(TT.str(), "", ""));
    Ctx = std::make_unique<MCContext>(TT, MAI.get(), MRI.get(), STI.get());
    Decoder.reset(T.createMCDisassembler(*STI, *Ctx));
    Encoder.reset(T.createMCCodeEmitter(*MII, *Ctx));
    Printer.reset(T.createMCInstPrinter(TT, 0, *MAI, *MII, *MRI));
    Printer->setPrintBranchImmAsAddress(true);
    Printer->applyTargetSpecificCLOption("no-aliases");
  }

  void check(uint32_t Word) {
    uint8_t Bytes[4];
    support::endian::write32le(Bytes, Word);
    MCInst Inst;
    uint64_t Size;
    bool IsLegal = Decoder->getInstruction(Inst, Size, Bytes, Address, nulls()) == MCDisassembler::Success;
    if (IsLegal != (trax_decode(Word).op != TRAX_OP_ILLEGAL)) {
      differ(Word, IsLegal ? "legal" : "illegal", IsLegal ? "illegal" : "legal");
      return;
    }
    ++(IsLegal ? Legal : Illegal);
    if (!IsLegal)
      return;

    std::string FromLLVM;
    raw_string_ostream OS(FromLLVM);
    Printer->printInst(&Inst, Address, "", *STI, OS);
    OS.flush();
    StringRef Text = StringRef(FromLLVM).trim(); // "\tmnemonic\toperands"
    FromLLVM = Text.str();
    std::replace(FromLLVM.begin(), FromLLVM.end(), '\t', ' ');
    char FromTable[128];
    trax_disassemble(Word, Address, FromTable, sizeof FromTable);
    if (FromLLVM != FromTable)
      differ(Word, FromLLVM, FromTable);

    SmallVector<char, 4> Encoded;
    SmallVector<MCFixup, 1> Fixups;
    Encoder->encodeInstruction(Inst, Encoded, Fixups, *STI);
    if (Encoded.size() != 4 || !Fixups.empty() || support::endian::read32le(Encoded.data()) != Word)
      differ(Word, "encoded otherwise than it was decoded", FromTable);
  }

private:
  void differ(uint32_t Word, StringRef LLVM, StringRef Table) {
    if (++Differences <= 20)
      errs() << format_hex(Word, 10) << ": LLVM: " << LLVM << ", table: " << Table << '\n';
  }
};

} // namespace

int main() {
  LLVMInitializeTrax();
  std::string Message;
  const Target *T = TargetRegistry::lookupTarget("trax", Message);
  if (!T) {
    errs() << Message << '\n';
    return 1;
  }
  Comparison C(*T);
  std::mt19937 Random(20080927);
  for (unsigned I = 0; I != RandomWords; ++I)
    C.check(Random());
  for (int Op = TRAX_OP_ILLEGAL + 1; Op != TRAX_OP_COUNT; ++Op)
    for (unsigned I = 0; I != WordsPerInstruction; ++I)
      C.check((uint32_t(Random()) & ~trax_op_table[Op].mask) | trax_op_table[Op].match);

  outs() << C.Legal << " legal words, " << C.Illegal << " illegal ones, " << C.Differences << " differences\n";
  // The random words alone must have met both kinds.
  return C.Differences == 0 && C.Legal > RandomWords / 100 && C.Illegal > RandomWords / 100 ? 0 : 1;
}
