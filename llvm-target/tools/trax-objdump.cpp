//===- trax-objdump.cpp - Lists a program --------------------------------===//
//
//   trax-objdump program        its instructions, with symbols
//   trax-objdump -t -r a.o      its symbols and relocations too
//
//===----------------------------------------------------------------------===//
#include "ToolSupport.h"
#include "trax/abi.h"
#include "llvm/MC/MCAsmInfo.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCDisassembler/MCDisassembler.h"
#include "llvm/MC/MCInst.h"
#include "llvm/MC/MCInstPrinter.h"
#include "llvm/MC/MCInstrAnalysis.h"
#include "llvm/MC/MCInstrInfo.h"
#include "llvm/MC/MCRegisterInfo.h"
#include "llvm/MC/MCSubtargetInfo.h"
#include "llvm/MC/MCTargetOptions.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Object/ELFObjectFile.h"
#include "llvm/Support/CommandLine.h"
#include "llvm/Support/Endian.h"
#include "llvm/Support/Format.h"
#include "llvm/Support/raw_ostream.h"
#include "llvm/TargetParser/Triple.h"
#include <map>

using namespace llvm;
using namespace llvm::object;

static cl::OptionCategory Category("Options of trax-objdump");
static cl::opt<std::string> Input(cl::Positional, cl::desc("<ELF file>"), cl::Required, cl::cat(Category));
static cl::opt<bool> NoAliases("no-aliases", cl::desc("Print every instruction under its own mnemonic"),
                               cl::cat(Category));
static cl::opt<bool> ShowSymbols("t", cl::desc("Print the symbols"), cl::cat(Category));
static cl::opt<bool> ShowRelocations("r", cl::desc("Print relocations below the instructions they belong to"),
                                     cl::cat(Category));
static cl::opt<bool> NoDisassembly("no-disassembly", cl::desc("Print no instructions"), cl::cat(Category));

static const char *relocationName(uint64_t Type) {
  switch (Type) {
#define CASE(NAME, NUMBER)                                                                                             \
  case NUMBER:                                                                                                         \
    return #NAME;
    TRAX_RELOCATIONS(CASE)
#undef CASE
  default:
    return "unknown relocation";
  }
}

namespace {

class Listing {
  const ELF32LEObjectFile &File;
  Triple TT{"trax"};
  MCTargetOptions Options;
  std::unique_ptr<MCRegisterInfo> MRI;
  std::unique_ptr<MCAsmInfo> MAI;
  std::unique_ptr<MCInstrInfo> MII;
  std::unique_ptr<MCSubtargetInfo> STI;
  std::unique_ptr<MCContext> Ctx;
  std::unique_ptr<MCDisassembler> Decoder;
  std::unique_ptr<MCInstPrinter> Printer;
  std::unique_ptr<MCInstrAnalysis> Analysis;
  /// Of one section (in an object, addresses of different sections overlap): names by address.
  using SymbolMap = std::multimap<uint64_t, std::string>;

public:
  Listing(const Target &T, const ELF32LEObjectFile &File) : File(File) {
    MRI.reset(T.createMCRegInfo(TT.str()));
    MAI.reset(T.createMCAsmInfo(*MRI, TT.str(), Options));
    MII.reset(T.createMCInstrInfo());
    STI.reset(T.createMCSubtargetInfo(TT.str(), "", ""));
    Ctx = std::make_unique<MCContext>(TT, MAI.get(), MRI.get(), STI.get());
    Decoder.reset(T.createMCDisassembler(*STI, *Ctx));
    Printer.reset(T.createMCInstPrinter(TT, 0, *MAI, *MII, *MRI));
    Printer->setPrintBranchImmAsAddress(true);
    Printer->setPrintImmHex(false);
    if (NoAliases)
      Printer->applyTargetSpecificCLOption("no-aliases");
    Analysis.reset(T.createMCInstrAnalysis(MII.get()));
  }

  Error printSymbols(raw_ostream &OS) const;
  Error printSection(const SectionRef &Section, raw_ostream &OS) const;

private:
  Expected<SymbolMap> symbolsOf(const SectionRef &Section) const;
  Error printRelocation(const RelocationRef &Relocation, raw_ostream &OS) const;
  void printTarget(const MCInst &Inst, uint64_t Address, const SectionRef &Section, const SymbolMap &Symbols,
                   raw_ostream &OS) const;
};

} // namespace

Error Listing::printSymbols(raw_ostream &OS) const {
  OS << "\nSymbols:\n";
  for (const ELFSymbolRef &Symbol : File.symbols()) {
    Expected<StringRef> Name = Symbol.getName();
    Expected<uint64_t> Value = Symbol.getValue();
    Expected<section_iterator> Section = Symbol.getSection();
    if (!Name || !Value || !Section)
      return joinErrors(joinErrors(Name.takeError(), Value.takeError()), Section.takeError());
    StringRef SectionName =
        Symbol.getFlags() && (*Symbol.getFlags() & SymbolRef::SF_Undefined) ? "*undefined*" : "*absolute*";
    if (*Section != File.section_end()) {
      Expected<StringRef> Found = (*Section)->getName();
      if (!Found)
        return Found.takeError();
      SectionName = *Found;
    }
    char Kind = Symbol.getBinding() == ELF::STB_LOCAL ? 'l' : Symbol.getBinding() == ELF::STB_WEAK ? 'w' : 'g';
    OS << format("%08x %c %-12s %6u ", unsigned(*Value), Kind, SectionName.str().c_str(), unsigned(Symbol.getSize()))
       << *Name << '\n';
  }
  return Error::success();
}

Expected<Listing::SymbolMap> Listing::symbolsOf(const SectionRef &Section) const {
  SymbolMap Symbols;
  for (const ELFSymbolRef &Symbol : File.symbols()) {
    Expected<section_iterator> Where = Symbol.getSection();
    Expected<StringRef> Name = Symbol.getName();
    Expected<uint64_t> Address = Symbol.getAddress();
    if (!Where || !Name || !Address)
      return joinErrors(joinErrors(Where.takeError(), Name.takeError()), Address.takeError());
    if (*Where != File.section_end() && **Where == Section && !Name->empty() &&
        Symbol.getELFType() != ELF::STT_SECTION && Symbol.getELFType() != ELF::STT_FILE)
      Symbols.emplace(*Address, Name->str());
  }
  return Symbols;
}

void Listing::printTarget(const MCInst &Inst, uint64_t Address, const SectionRef &Section, const SymbolMap &Symbols,
                          raw_ostream &OS) const {
  uint64_t Target;
  if (!Analysis->evaluateBranch(Inst, Address, 4, Target) || Target < Section.getAddress() ||
      Target >= Section.getAddress() + Section.getSize())
    return;
  auto Next = Symbols.upper_bound(Target);
  if (Next == Symbols.begin())
    return;
  auto Symbol = std::prev(Next);
  OS << " <" << Symbol->second;
  if (Target != Symbol->first)
    OS << format("+0x%x", unsigned(Target - Symbol->first));
  OS << '>';
}

Error Listing::printRelocation(const RelocationRef &Relocation, raw_ostream &OS) const {
  OS << format("                  %08x: ", unsigned(Relocation.getOffset())) << relocationName(Relocation.getType())
     << ' ';
  symbol_iterator Symbol = Relocation.getSymbol();
  if (Symbol != File.symbol_end()) {
    Expected<StringRef> Name = Symbol->getName();
    if (!Name)
      return Name.takeError();
    if (Name->empty()) {
      Expected<section_iterator> Section = Symbol->getSection();
      if (!Section)
        return Section.takeError();
      if (*Section != File.section_end())
        Name = (*Section)->getName();
      if (!Name)
        return Name.takeError();
    }
    OS << *Name;
  }
  Expected<int64_t> Addend = ELFRelocationRef(Relocation).getAddend();
  if (!Addend)
    return Addend.takeError();
  if (*Addend != 0)
    OS << (*Addend < 0 ? "-" : "+") << format("0x%x", unsigned(std::abs(*Addend)));
  OS << '\n';
  return Error::success();
}

Error Listing::printSection(const SectionRef &Section, raw_ostream &OS) const {
  Expected<StringRef> Name = Section.getName();
  Expected<StringRef> Contents = Section.getContents();
  Expected<SymbolMap> Symbols = symbolsOf(Section);
  if (!Name || !Contents || !Symbols)
    return joinErrors(joinErrors(Name.takeError(), Contents.takeError()), Symbols.takeError());

  std::multimap<uint64_t, RelocationRef> Relocations;
  if (ShowRelocations)
    for (const SectionRef &Other : File.sections()) {
      Expected<section_iterator> Target = Other.getRelocatedSection();
      if (!Target)
        return Target.takeError();
      if (*Target != File.section_end() && **Target == Section)
        for (const RelocationRef &Relocation : Other.relocations())
          Relocations.emplace(Relocation.getOffset(), Relocation);
    }

  OS << "\nSection " << *Name << ":\n";
  ArrayRef<uint8_t> Bytes = arrayRefFromStringRef(*Contents);
  auto Symbol = Symbols->begin();
  for (uint64_t Offset = 0; Offset < Bytes.size(); Offset += 4) {
    uint64_t Address = Section.getAddress() + Offset;
    for (; Symbol != Symbols->end() && Symbol->first < Address + 4; ++Symbol)
      OS << format("\n%08x <", unsigned(Symbol->first)) << Symbol->second << ">:\n";
    if (Bytes.size() - Offset < 4) {
      OS << format("%8x: ", unsigned(Address)) << "(" << Bytes.size() - Offset << " bytes)\n";
      break;
    }
    MCInst Inst;
    uint64_t Size;
    OS << format("%8x: %08x  ", unsigned(Address), support::endian::read32le(Bytes.data() + Offset));
    if (Decoder->getInstruction(Inst, Size, Bytes.slice(Offset), Address, nulls()) == MCDisassembler::Success) {
      Printer->printInst(&Inst, Address, "", *STI, OS);
      printTarget(Inst, Address, Section, *Symbols, OS);
    } else {
      OS << "\t.word\t" << format_hex(support::endian::read32le(Bytes.data() + Offset), 10);
    }
    OS << '\n';
    for (auto [It, End] = Relocations.equal_range(Offset); It != End; ++It)
      if (Error E = printRelocation(It->second, OS))
        return E;
  }
  return Error::success();
}

int main(int Argc, char **Argv) {
  cl::HideUnrelatedOptions(Category);
  const Target &T = trax::startTool(Argc, Argv, "TRaX program listing\n");
  Expected<OwningBinary<ObjectFile>> Binary = ObjectFile::createObjectFile(Input);
  if (!Binary)
    trax::fail(Binary.takeError(), Input);
  const auto *File = dyn_cast<ELF32LEObjectFile>(Binary->getBinary());
  if (!File || File->getELFFile().getHeader().e_machine != TRAX_EM)
    trax::fail("'" + Input + "': not an ELF file for TRaX");

  std::string Text;
  raw_string_ostream OS(Text);
  OS << Input << ":\n";
  Listing List(T, *File);
  if (ShowSymbols)
    if (Error E = List.printSymbols(OS))
      trax::fail(std::move(E), Input);
  if (!NoDisassembly)
    for (const SectionRef &Section : File->sections())
      if (Section.isText() && Section.getSize() != 0)
        if (Error E = List.printSection(Section, OS))
          trax::fail(std::move(E), Input);
  outs() << OS.str();
  return 0;
}
