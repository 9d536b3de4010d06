// docs/isa.md: the template's text with the instructions filled in.

#include "Isa.h"
#include "trax/ray_kinds.h"
#include "llvm/ADT/StringExtras.h"
#include "llvm/Support/MemoryBuffer.h"
#include "llvm/TableGen/Error.h"
#include <algorithm>
#include <functional>

using namespace llvm;

namespace trax {

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
    if (I.ImmFirst)
      OS << " Values below " << I.ImmFirst << " are illegal.";
    OS << "\n";
  }
}

static void emitDetails(raw_ostream &OS, const Isa &Isa) {
  for (const Instruction &I : Isa.Instructions) {
    OS << "### " << I.Mnemonic << "\n\n`" << I.Mnemonic << (I.AssemblerText.empty() ? "" : " ") << I.AssemblerText
       << "`: " << I.Manual << "\n\n";
    OS << "```\n";
    drawWord(OS, I);
    OS << "```\n";
    describeImmediate(OS, I);
    OS << "\nSemantics: `" << I.Semantics << "`\n\n";
  }
}

static void emitUnitTable(raw_ostream &OS, const Isa &Isa) {
  OS << "| unit | latency | what |\n| --- | --- | --- |\n";
  for (const Unit &U : Isa.Units)
    OS << "| " << U.Name << " | " << U.Latency << " | " << U.Description << " |\n";
}

static void emitRegisters(raw_ostream &OS, const Isa &Isa) {
  const size_t Columns = 4, Rows = (Isa.Registers.size() + Columns - 1) / Columns;
  for (size_t Column = 0; Column < Columns; ++Column)
    OS << "| register | name ";
  OS << "|\n";
  for (size_t Column = 0; Column < Columns; ++Column)
    OS << "| --- | --- ";
  OS << "|\n";
  for (size_t Row = 0; Row < Rows; ++Row) {
    for (size_t At = Row; At < Isa.Registers.size(); At += Rows)
      OS << "| " << Isa.Registers[At].Name << " | " << Isa.Registers[At].OtherName << " ";
    OS << "|\n";
  }
}

static void emitAliases(raw_ostream &OS, const Isa &Isa) {
  OS << "| shorthand | stands for | printed by the disassembler |\n| --- | --- | --- |\n";
  for (const Alias &A : Isa.Aliases)
    OS << "| `" << A.Syntax << "` | " << A.Expansion << " | " << (A.IsPrinted ? "yes" : "no") << " |\n";
}

// The template explains the description's names by hand. Each name must have its row there.
static void checkTemplate(StringRef Text, const std::string &Path, const Isa &Isa) {
  auto Require = [&](const Twine &Row) {
    if (!Text.contains(("\n| " + Row).str()))
      PrintFatalError(Path + ": there is no row '| " + Row + "'");
  };
  for (const Numbers &List : Isa.Named)
    for (size_t N = 0; N < List.Names.size(); ++N)
      Require(Twine(List.First + N) + " | `" + List.Names[N] + "` |");
#define ROW(X, ID, NAME, NUMBER, MEANING) Require(Twine(NUMBER) + " | `" #NAME "` | " MEANING " |");
  TRAX_RAY_KINDS(ROW, )
#undef ROW
  for (const Instruction &I : Isa.Instructions) {
    StringRef Rest = I.Semantics;
    while (!Rest.empty()) {
      StringRef Word = Rest.take_while([](char C) { return isAlnum(C) || C == '_'; });
      Rest = Rest.drop_front(std::max<size_t>(Word.size(), 1));
      if (!Word.empty() && Rest.starts_with("("))
        Require("`" + Word + "(");
    }
  }
}

void emitManual(raw_ostream &OS, const Isa &Isa, const std::string &TemplatePath) {
  auto Buffer = MemoryBuffer::getFile(TemplatePath);
  if (!Buffer)
    PrintFatalError(TemplatePath + ": " + Buffer.getError().message());
  StringRef Text = (*Buffer)->getBuffer();
  checkTemplate(Text, TemplatePath, Isa);
  const std::pair<StringRef, std::function<void()>> Parts[] = {
      {"@REGISTERS@", [&] { emitRegisters(OS, Isa); }},
      {"@SPECIAL-CASES@", [&] { emitSpecialCases(OS); }},
      {"@ROUNDING@", [&] { emitRounding(OS); }},
      {"@CONVERSIONS@", [&] { emitConversions(OS); }},
      {"@REDUCED-PRECISION@", [&] { emitReducedPrecision(OS); }},
      {"@FORMATS@", [&] { emitFormats(OS, Isa); }},
      {"@OPCODES@", [&] { emitOpcodes(OS, Isa); }},
      {"@ALIASES@", [&] { emitAliases(OS, Isa); }},
      {"@SUMMARY@", [&] { emitSummary(OS, Isa); }},
      {"@UNITS@", [&] { emitUnitTable(OS, Isa); }},
      {"@INSTRUCTIONS@", [&] { emitDetails(OS, Isa); }},
  };
  while (!Text.empty()) {
    auto [Line, Rest] = Text.split('\n');
    auto Part = std::find_if(std::begin(Parts), std::end(Parts), [Line = Line](auto &P) { return P.first == Line; });
    if (Part != std::end(Parts))
      Part->second();
    else if (Line.starts_with("@"))
      PrintFatalError(TemplatePath + ": there is no part " + Line);
    else
      OS << Line << "\n";
    Text = Rest;
  }
}

} // namespace trax
