// docs/isa.md: the template's text with the instructions filled in.

#include "Isa.h"
#include "llvm/ADT/StringExtras.h"
#include "llvm/Support/MemoryBuffer.h"
#include "llvm/TableGen/Error.h"

using namespace llvm;

namespace trax {

// One box per run of bits, most significant first, as wide as its contents need.
static void drawWord(raw_ostream &OS, const Instruction &I) {
  struct Box {
    unsigned High, Low;
    std::string Text;
  };
  std::vector<Box> Boxes;
  auto AddFixed = [&](unsigned High, unsigned Low) {
    // The opcode and the function code are boxes of their own; zeros between them too.
    auto Push = [&](unsigned H, unsigned L) {
      uint32_t Value = (I.Match >> L) & ((uint64_t(1) << (H - L + 1)) - 1);
      Boxes.push_back({H, L, utostr(Value)});
    };
    if (High == 31) {
      Push(31, 26);
      if (Low == 26)
        return;
      High = 25;
    }
    if (Low == 0 && High > 5 && I.Format[0] == 'R') {
      Push(High, 6);
      High = 5;
    }
    Push(High, Low);
  };
  unsigned Next = 31;
  for (const Field &F : I.Fields) {
    unsigned High = F.Low + F.Width - 1;
    if (High < Next)
      AddFixed(Next, High + 1);
    Boxes.push_back({High, F.Low, F.Name});
    Next = F.Low - 1; // wraps after bit 0
  }
  if (Next != ~0u)
    AddFixed(Next, 0);

  std::string Numbers = "   ", Line = "  |";
  for (const Box &B : Boxes) {
    std::string Range = utostr(B.High) + (B.High == B.Low ? "" : ".." + utostr(B.Low));
    size_t Width = std::max(Range.size(), B.Text.size()) + 2;
    auto Centre = [&](const std::string &Text) {
      size_t Left = (Width - Text.size()) / 2;
      return std::string(Left, ' ') + Text + std::string(Width - Text.size() - Left, ' ');
    };
    Numbers += Centre(Range) + " ";
    Line += Centre(B.Text) + "|";
  }
  OS << "```\n" << StringRef(Numbers).rtrim() << "\n" << Line << "\n```\n";
}

static void emitSummary(raw_ostream &OS, const Isa &Isa) {
  OS << "| instruction | format | unit | latency | what |\n| --- | --- | --- | --- | --- |\n";
  for (const Instruction &I : Isa.Instructions) {
    int64_t Latency = 1;
    for (const Unit &U : Isa.Units)
      if (U.Name == I.Unit)
        Latency = U.Latency;
    OS << "| `" << I.Mnemonic << (I.AssemblerText.empty() ? "" : " ") << I.AssemblerText << "` | " << I.Format << " | "
       << I.Unit << " | " << Latency << " | " << I.Manual << " |\n";
  }
}

// How the semantics' IMM comes from its field.
static void describeImmediate(raw_ostream &OS, const Instruction &I) {
  for (const Field &F : I.Fields) {
    if (F.Name != "imm" && F.Name != "offset")
      continue;
    OS << "\nIMM is bits " << F.Low + F.Width - 1 << ".." << F.Low << ", " << (I.ImmSigned ? "sign" : "zero")
       << " extended";
    if (I.ImmScale != 1)
      OS << ", times " << I.ImmScale;
    OS << ".";
    if (I.ImmLimit >= 0)
      OS << " Values of " << I.ImmLimit << " and above are illegal.";
    OS << "\n";
  }
}

static void emitDetails(raw_ostream &OS, const Isa &Isa) {
  for (const Instruction &I : Isa.Instructions) {
    OS << "### " << I.Mnemonic << "\n\n`" << I.Mnemonic << (I.AssemblerText.empty() ? "" : " ") << I.AssemblerText
       << "`: " << I.Manual << "\n\n";
    drawWord(OS, I);
    describeImmediate(OS, I);
    OS << "\nSemantics: `" << I.Semantics << "`\n\n";
  }
}

static void emitUnitTable(raw_ostream &OS, const Isa &Isa) {
  OS << "| unit | latency | what |\n| --- | --- | --- |\n";
  for (const Unit &U : Isa.Units)
    OS << "| " << U.Name << " | " << U.Latency << " | " << U.Description << " |\n";
}

void emitManual(raw_ostream &OS, const Isa &Isa, const std::string &TemplatePath) {
  auto Buffer = MemoryBuffer::getFile(TemplatePath);
  if (!Buffer)
    PrintFatalError(TemplatePath + ": " + Buffer.getError().message());
  StringRef Text = (*Buffer)->getBuffer();
  while (!Text.empty()) {
    auto [Line, Rest] = Text.split('\n');
    if (Line == "@SUMMARY@")
      emitSummary(OS, Isa);
    else if (Line == "@UNITS@")
      emitUnitTable(OS, Isa);
    else if (Line == "@INSTRUCTIONS@")
      emitDetails(OS, Isa);
    else
      OS << Line << "\n";
    Text = Rest;
  }
}

} // namespace trax
