// The manual's pictures of encodings: words with their fields to scale, the map of the opcodes.

#include "Isa.h"
#include "llvm/ADT/StringExtras.h"
#include "llvm/Support/Format.h"
#include <set>

using namespace llvm;

namespace trax {

namespace {

struct Box {
  unsigned High, Low;
  std::string Text;
};

} // namespace

// The function code's field, if the format has one.
static bool hasFunctionCode(const Instruction &I) {
  return I.Format[0] == 'R';
}

// The fields and, where fixed bits have values of their own (opcode, function code), boxes for these; most significant
// first.
static std::vector<Box> boxes(const Instruction &I, bool ShowValues) {
  std::vector<Box> Boxes = {{31, 26, ShowValues ? utostr(I.opcode()) : "opcode"}};
  unsigned Next = 25; // the highest bit that is not yet in a box; wraps after bit 0
  auto AddZeros = [&](unsigned Low) {
    if (Next != ~0u && Next >= Low)
      Boxes.push_back({Next, Low, "0"});
    Next = Low - 1;
  };
  for (const Field &F : I.Fields) {
    AddZeros(F.Low + F.Width);
    bool IsNumber = F.Name == "imm" || F.Name == "offset";
    Boxes.push_back({F.Low + F.Width - 1, F.Low, F.Name + (IsNumber && !ShowValues ? utostr(F.Width) : "")});
    Next = F.Low - 1;
  }
  if (hasFunctionCode(I)) {
    AddZeros(6);
    Boxes.push_back({5, 0, ShowValues ? utostr(I.Match & 0x3F) : "func"});
  } else if (Next != ~0u) {
    AddZeros(0);
  }
  return Boxes;
}

// Two columns for each bit, a box's right border among them.
static std::string centre(const Box &B, const std::string &Text) {
  size_t Width = 2 * (B.High - B.Low + 1) - 1, Left = (Width - Text.size()) / 2;
  return std::string(Left, ' ') + Text + std::string(Width - Text.size() - Left, ' ');
}

static std::string drawBoxes(const std::vector<Box> &Boxes) {
  std::string Line = "|";
  for (const Box &B : Boxes)
    Line += centre(B, B.Text) + "|";
  return Line;
}

static std::string drawNumbers(const std::vector<Box> &Boxes) {
  std::string Line = " ";
  for (const Box &B : Boxes)
    Line += centre(B, utostr(B.High) + ".." + utostr(B.Low)) + " ";
  return StringRef(Line).rtrim().str();
}

void drawWord(raw_ostream &OS, const Instruction &I) {
  const std::vector<Box> Boxes = boxes(I, true);
  OS << drawNumbers(Boxes) << "\n" << drawBoxes(Boxes) << "\n";
}

void emitFormats(raw_ostream &OS, const Isa &Isa) {
  OS << "```\n";
  for (const Format &F : Isa.Formats) {
    auto First = std::find_if(Isa.Instructions.begin(), Isa.Instructions.end(),
                              [&](const Instruction &I) { return I.Format == F.Name; });
    const std::vector<Box> Boxes = boxes(*First, false);
    OS << "    " << drawNumbers(Boxes) << "\n " << left_justify(F.Name, 3) << drawBoxes(Boxes) << "  " << F.Description
       << "\n";
  }
  OS << "```\n";
}

static std::string nameOpcode(const Isa &Isa, unsigned Opcode) {
  for (const Instruction &I : Isa.Instructions)
    if (I.opcode() == Opcode)
      return hasFunctionCode(I) ? "*func*" : "`" + I.Mnemonic + "`";
  return "";
}

void emitOpcodes(raw_ostream &OS, const Isa &Isa) {
  OS << "| bits 31..29 \\ 28..26 | 000 | 001 | 010 | 011 | 100 | 101 | 110 | 111 |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (unsigned Row = 0; Row < 8; ++Row) {
    OS << "| " << (Row >> 2 & 1) << (Row >> 1 & 1) << (Row & 1) << " (" << 8 * Row << ".." << 8 * Row + 7 << ") |";
    for (unsigned Opcode = 8 * Row; Opcode < 8 * Row + 8; ++Opcode)
      OS << " " << nameOpcode(Isa, Opcode) << " |";
    OS << "\n";
  }
  OS << "\n| opcode | func | instruction | format |\n| --- | --- | --- | --- |\n";
  for (const Instruction &I : Isa.Instructions)
    if (hasFunctionCode(I))
      OS << "| " << I.opcode() << " | " << (I.Match & 0x3F) << " | `" << I.Mnemonic << "` | " << I.Format << " |\n";
  uint64_t Legal = 0;
  for (const Instruction &I : Isa.Instructions) {
    uint64_t Words = 1;
    for (const Field &F : I.Fields)
      Words *= F.Name == "imm" && I.ImmLimit >= 0 ? I.ImmLimit - I.ImmFirst : uint64_t(1) << F.Width;
    Legal += Words;
  }
  OS << "\nOf the 2^32 words " << Legal << " are instructions.\n";
}

} // namespace trax
