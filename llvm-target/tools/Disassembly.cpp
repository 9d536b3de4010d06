//===- Disassembly.cpp - Instructions with symbols, lines and units ------===//
#include "Decoder.h"
#include "Listing.h"
#include "SourceLines.h"
#include "trax/isa.h"
#include "llvm/ADT/STLExtras.h"
#include "llvm/ADT/StringExtras.h"
#include "llvm/ADT/StringSet.h"
#include "llvm/MC/MCInstrAnalysis.h"
#include "llvm/Support/Endian.h"
#include "llvm/Support/Format.h"
#include "llvm/Support/raw_ostream.h"
#include <array>
#include <map>

using namespace llvm;
using namespace trax;

namespace {

class Disassembly {
public:
  Disassembly(const Target &T, const ElfFile &File, const ListingOptions &Options, raw_ostream &OS);
  Error readLines();
  void print(const Section &S);
  StringSet<> Found; ///< of Options.OnlySymbols

private:
  void printSymbols(uint32_t Address);
  void printLine(uint32_t Address);
  void printInstruction(uint32_t Address, uint32_t Offset);
  void printTarget(const MCInst &Inst, uint32_t Address, const Relocation *Patch);
  void printAddress(uint32_t Word);
  bool printNearest(uint32_t Address, bool OnlyWithin);
  void printData(uint32_t Address, ArrayRef<uint8_t> Bytes);
  void printRelocations(uint32_t Begin, uint32_t End);
  const Relocation *relocationAt(uint32_t Offset) const;
  bool isWanted(uint32_t Address) const;
  void printSourceLine(const std::string &Path, uint32_t Line);

  const ElfFile &File;
  const ListingOptions &Options;
  raw_ostream &OS;
  const Decoder LLVM;
  std::unique_ptr<MCInstrAnalysis> Analysis;

  SourceLines Lines;
  struct SourceText {
    std::string Text;
    std::vector<StringRef> Lines;
  };
  std::map<std::string, SourceText> Sources;

  // The section that is being printed, and the current place in it.
  const Section *Current = nullptr;
  size_t NextSymbol = 0;
  const Symbol *Covering = nullptr; ///< the last symbol at or before the place that is a function, an object or a label
  std::optional<SourceLines::Place> LastPlace;
  std::array<std::optional<uint32_t>, TRAX_NUM_REGISTERS>
      Known; ///< what lui and addi made, in the order of the listing
};

} // namespace

Disassembly::Disassembly(const Target &T, const ElfFile &File, const ListingOptions &Options, raw_ostream &OS)
    : File(File), Options(Options), OS(OS), LLVM(T), Analysis(T.createMCInstrAnalysis(LLVM.MII.get())) {}

Error Disassembly::readLines() {
  if (!Options.LineNumbers && !Options.Source)
    return Error::success();
  auto Warn = [&](Error E) { Options.Warning(toString(std::move(E))); };
  Expected<SourceLines> Read = SourceLines::read(File, Warn);
  if (!Read)
    return Read.takeError();
  Lines = std::move(*Read);
  return Error::success();
}

bool Disassembly::isWanted(uint32_t Address) const {
  if (Address < Options.Start || Address >= Options.Stop)
    return false;
  return Options.OnlySymbols.empty() || (Covering && is_contained(Options.OnlySymbols, Covering->Name) &&
                                         (Covering->Size == 0 || Address - Covering->Value < Covering->Size));
}

/// Passes the symbols up to and including the address, and prints those at the address as headings.
void Disassembly::printSymbols(uint32_t Address) {
  const std::vector<const Symbol *> &Symbols = Current->Symbols;
  uint32_t Base = File.isRelocatable() ? Current->Address : 0;
  size_t First = NextSymbol;
  while (NextSymbol < Symbols.size() && Symbols[NextSymbol]->Value + Base <= Address)
    ++NextSymbol;
  // Several symbols may have one address: chooses one that was asked for, else a function, else the last.
  auto Rank = [&](const Symbol *S) {
    return 2 * is_contained(Options.OnlySymbols, S->Name) + (S->Type == ELF::STT_FUNC || S->Type == ELF::STT_OBJECT);
  };
  for (size_t I = First; I != NextSymbol; ++I) {
    const Symbol *S = Symbols[I];
    if (is_contained(Options.OnlySymbols, S->Name))
      Found.insert(S->Name);
    if (S->Type == ELF::STT_FUNC)
      Known.fill(std::nullopt);
    if (!Covering || Covering->Value != S->Value || Rank(S) >= Rank(Covering))
      Covering = S;
  }
  if (First == NextSymbol || !isWanted(Address))
    return;
  for (size_t I = First; I != NextSymbol; ++I)
    if (Symbols[I]->Value + Base == Address)
      OS << format("\n%08x <", Address) << Symbols[I]->Name << ">:\n";
  LastPlace.reset();
}

void Disassembly::printSourceLine(const std::string &Path, uint32_t Line) {
  auto [At, IsNew] = Sources.try_emplace(Path);
  SourceText &Source = At->second;
  if (IsNew) {
    if (std::optional<std::string> Text = Options.ReadSource(Path)) {
      Source.Text = std::move(*Text);
      for (StringRef Rest = Source.Text; !Rest.empty();) {
        auto [First, Others] = Rest.split('\n');
        Source.Lines.push_back(First.rtrim('\r'));
        Rest = Others;
      }
    } else {
      Options.Warning("cannot read the source file '" + Path + "'");
    }
  }
  if (Line >= 1 && Line <= Source.Lines.size())
    OS << "; " << Source.Lines[Line - 1] << '\n';
}

void Disassembly::printLine(uint32_t Address) {
  if (!Options.LineNumbers && !Options.Source)
    return;
  std::optional<SourceLines::Place> Place = Lines.find(*Current, Address);
  if (!Place || Place->Line == 0 || (LastPlace && LastPlace->Line == Place->Line && LastPlace->File == Place->File))
    return;
  if (Options.LineNumbers)
    OS << "; " << Place->File << ':' << Place->Line << '\n';
  if (Options.Source)
    printSourceLine(Place->File, Place->Line);
  LastPlace = std::move(Place);
}

const Relocation *Disassembly::relocationAt(uint32_t Offset) const {
  auto Found = partition_point(Current->Relocations, [Offset](const Relocation &R) { return R.Offset < Offset; });
  return Found != Current->Relocations.end() && Found->Offset == Offset ? &*Found : nullptr;
}

/// Prints what an instruction refers to: the symbol of its relocation, or the target of a branch.
void Disassembly::printTarget(const MCInst &Inst, uint32_t Address, const Relocation *Patch) {
  if (Patch && Patch->Target) {
    OS << " <";
    printPlace(OS, Patch->Target->Name, Patch->Addend);
    OS << '>';
    return;
  }
  uint64_t Target;
  if (Analysis->evaluateBranch(Inst, Address, 4, Target))
    printNearest(Target, /*OnlyWithin=*/false);
}

/// " <symbol+offset>" of the symbol at or before an address of this section or, in an executable, of any.
/// OnlyWithin: not beyond the symbol's size.
bool Disassembly::printNearest(uint32_t Address, bool OnlyWithin) {
  const Section *Where = Current;
  if (!File.isRelocatable() && Address - Current->Address >= Current->Size)
    for (const Section &S : File.sections())
      if (S.Flags & ELF::SHF_ALLOC && Address - S.Address < S.Size)
        Where = &S;
  uint32_t Base = File.isRelocatable() ? Where->Address : 0;
  auto Next = partition_point(Where->Symbols, [&](const Symbol *S) { return S->Value + Base <= Address; });
  if (Address - Where->Address >= Where->Size || Next == Where->Symbols.begin())
    return false;
  const Symbol *Name = *std::prev(Next);
  for (auto At = Next; At != Where->Symbols.begin() && (*std::prev(At))->Value == (*std::prev(Next))->Value; --At)
    if ((*std::prev(At))->Type == ELF::STT_FUNC)
      Name = *std::prev(At);
  uint32_t Distance = Address - (Name->Value + Base);
  if (OnlyWithin && Distance != 0 && Distance >= Name->Size)
    return false;
  OS << " <";
  printPlace(OS, Name->Name, Distance);
  OS << '>';
  return true;
}

/// Linked code makes an address by lui and a signed 16-bit immediate: name it where it is complete.
void Disassembly::printAddress(uint32_t Word) {
  trax_inst Inst = trax_decode(Word);
  const trax_op_info &Info = trax_op_table[Inst.op];
  bool IsMemory = Info.flags & (TRAX_IS_LOAD | TRAX_IS_STORE);
  std::optional<uint32_t> Value;
  if (Inst.op == TRAX_OP_LUI)
    Value = uint32_t(Inst.imm) << 16;
  else if ((IsMemory || Inst.op == TRAX_OP_ADDI) && Inst.ra != 0 && Known[Inst.ra])
    Value = *Known[Inst.ra] + uint32_t(Inst.imm);
  if (Value && Inst.op != TRAX_OP_LUI)
    printNearest(*Value, /*OnlyWithin=*/true);
  if (Info.flags & TRAX_WRITES_RD)
    Known[Inst.rd] = IsMemory ? std::nullopt : Value;
  if (Info.flags & TRAX_IS_BRANCH)
    for (unsigned R = 4; R != 20; ++R) // a call or a jump: callee-saved registers keep their values
      if (Inst.op == TRAX_OP_JAL || Inst.op == TRAX_OP_JALR)
        Known[R] = std::nullopt;
}

void Disassembly::printInstruction(uint32_t Address, uint32_t Offset) {
  ArrayRef<uint8_t> Bytes = Current->Contents.slice(Offset, 4);
  uint32_t Word = support::endian::read32le(Bytes.data());
  if (Options.Addresses)
    OS << format("%8x: ", Address);
  if (Options.Words)
    OS << format("%08x  ", Word);
  SmallString<80> Text;
  raw_svector_ostream Line(Text);
  MCInst Inst;
  bool IsLegal = LLVM.decode(Inst, Bytes, Address);
  // The alias "mv r4, r4" would hide an immediate that the linker has yet to fill in.
  const Relocation *Patch = relocationAt(Offset);
  bool Fills = Patch && (Patch->Type == R_TRAX_LO16 || Patch->Type == R_TRAX_IMM16);
  if (IsLegal)
    (Options.Aliases && !Fills ? LLVM.Printer : LLVM.PlainPrinter)->printInst(&Inst, Address, "", *LLVM.STI, Line);
  else
    Line << "\t.word\t" << format_hex(Word, 10);
  OS << Text;
  if (IsLegal) {
    printTarget(Inst, Address, Patch);
    if (!File.isRelocatable())
      printAddress(Word);
    if (Options.Units) {
      trax_unit Unit = trax_op_table[trax_decode(Word).op].unit;
      OS << "\t# " << trax_unit_names[Unit] << ", " << trax_unit_latency[Unit]
         << (trax_unit_latency[Unit] == 1 ? " cycle" : " cycles");
    }
  }
  OS << '\n';
}

void Disassembly::printData(uint32_t Address, ArrayRef<uint8_t> Bytes) {
  if (Options.Addresses)
    OS << format("%8x: ", Address);
  std::string Text;
  for (uint8_t Byte : Bytes) {
    OS << format("%02x ", Byte);
    Text += isPrint(char(Byte)) ? char(Byte) : '.';
  }
  OS << std::string(3 * (4 - Bytes.size()), ' ') << ' ' << Text << '\n';
}

void Disassembly::printRelocations(uint32_t Begin, uint32_t End) {
  if (!Options.Relocations)
    return;
  auto At = partition_point(Current->Relocations, [Begin](const Relocation &R) { return R.Offset < Begin; });
  for (; At != Current->Relocations.end() && At->Offset < End; ++At) {
    OS << format("                  %08x: ", At->Offset) << relocationName(At->Type) << ' ';
    printPlace(OS, At->Target ? At->Target->Name : "*absolute*", At->Addend);
    OS << '\n';
  }
}

void Disassembly::print(const Section &S) {
  Current = &S;
  NextSymbol = 0;
  Covering = nullptr;
  LastPlace.reset();
  bool HasHeading = false;
  for (uint32_t Offset = 0, Step; Offset < S.Contents.size(); Offset += Step) {
    uint32_t Address = S.Address + Offset, Left = S.Contents.size() - Offset;
    if (!HasHeading && Options.OnlySymbols.empty()) {
      OS << "\nDisassembly of section " << S.Name << ":\n";
      HasHeading = true;
    }
    printSymbols(Address);
    bool IsData = !S.isCode() || Offset % 4 != 0 || Left < 4 ||
                  (Covering && Covering->Type == ELF::STT_OBJECT && Address - Covering->Value < Covering->Size);
    // Up to the next symbol or multiple of 4.
    Step = std::min(Left, 4 - Offset % 4);
    if (NextSymbol < S.Symbols.size()) {
      uint32_t Next = S.Symbols[NextSymbol]->Value - (File.isRelocatable() ? 0 : S.Address);
      if (Next > Offset && Next - Offset < Step) {
        Step = Next - Offset;
        IsData = true;
      }
    }
    if (!isWanted(Address))
      continue;
    if (IsData) {
      printData(Address, S.Contents.slice(Offset, Step));
    } else {
      printLine(Address);
      printInstruction(Address, Offset);
    }
    printRelocations(Offset, Offset + Step);
  }
}

Error trax::disassemble(const Target &T, const ElfFile &File, const ListingOptions &Options, raw_ostream &OS) {
  Disassembly D(T, File, Options, OS);
  if (Error E = D.readLines())
    return E;
  for (const Section &S : File.sections()) {
    bool IsListed = S.isCode() || !Options.OnlySections.empty() || (Options.Data && S.Flags & ELF::SHF_ALLOC);
    if (isSelected(S, Options) && IsListed && !S.Contents.empty())
      D.print(S);
  }
  for (const std::string &Name : Options.OnlySymbols)
    if (!D.Found.contains(Name))
      return createStringError(inconvertibleErrorCode(), "has no code or data for the symbol '" + Name + "'");
  return Error::success();
}
