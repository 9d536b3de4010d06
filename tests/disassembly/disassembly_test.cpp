//===- disassembly_test.cpp - LLVM's tables against the C tables ---------===//
//
// Both are generated from isa/TraxInstructions.td by different generators. For random words, and for random operands of
// every instruction: the same words are legal, they read the same, and decoded words are encoded to themselves.
//
//===----------------------------------------------------------------------===//
#include "LLVMTrax.h"
#include "tools/Decoder.h"
#include "trax/abi.h"
#include "trax/isa.h"
#include "llvm/MC/MCCodeEmitter.h"
#include "llvm/MC/MCFixup.h"
#include "llvm/Support/Endian.h"
#include "llvm/Support/raw_ostream.h"
#include <random>

using namespace llvm;

namespace {

constexpr unsigned RandomWords = 1u << 21;
constexpr unsigned WordsPerInstruction = 1u << 14;
constexpr uint64_t Address = 0x00400000;

class Comparison {
  const trax::Decoder LLVM;
  const std::unique_ptr<MCCodeEmitter> Encoder;

public:
  uint64_t Legal = 0, Illegal = 0, Differences = 0;

  explicit Comparison(const Target &T) : LLVM(T), Encoder(T.createMCCodeEmitter(*LLVM.MII, *LLVM.Ctx)) {}

  void check(uint32_t Word) {
    uint8_t Bytes[4];
    support::endian::write32le(Bytes, Word);
    MCInst Inst;
    const bool IsLegal = LLVM.decode(Inst, Bytes, Address);
    if (IsLegal != (trax_decode(Word).op != TRAX_OP_ILLEGAL)) {
      differ(Word, IsLegal ? "legal" : "illegal", IsLegal ? "illegal" : "legal");
      return;
    }
    ++(IsLegal ? Legal : Illegal);
    if (!IsLegal)
      return;

    std::string FromLLVM;
    raw_string_ostream OS(FromLLVM);
    LLVM.PlainPrinter->printInst(&Inst, Address, "", *LLVM.STI, OS);
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
    Encoder->encodeInstruction(Inst, Encoded, Fixups, *LLVM.STI);
    if (Encoded.size() != 4 || !Fixups.empty() || support::endian::read32le(Encoded.data()) != Word)
      differ(Word, "encoded otherwise than it was decoded", FromTable);
  }

private:
  void differ(uint32_t Word, StringRef Ours, StringRef Table) {
    if (++Differences <= 20)
      errs() << format_hex(Word, 10) << ": LLVM: " << Ours << ", table: " << Table << '\n';
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
