//===- Listing.cpp - Headers, symbols, relocations, contents -------------===//
#include "Listing.h"
#include "trax/abi.h"
#include "llvm/ADT/STLExtras.h"
#include "llvm/Support/Format.h"
#include "llvm/Support/raw_ostream.h"

using namespace llvm;
using namespace trax;

bool trax::isSelected(const Section &S, const ListingOptions &Options) {
  return S.Index != 0 && (Options.OnlySections.empty() || is_contained(Options.OnlySections, S.Name));
}

void trax::printPlace(raw_ostream &OS, StringRef Name, int64_t Offset) {
  OS << Name;
  if (Offset != 0)
    OS << (Offset < 0 ? '-' : '+') << format("0x%llx", static_cast<unsigned long long>(std::abs(Offset)));
}

static void printFileHeader(const ElfFile &File, raw_ostream &OS) {
  const ELF::Elf32_Ehdr &Header = File.header();
  const char *Type = Header.e_type == ELF::ET_REL    ? "relocatable object"
                     : Header.e_type == ELF::ET_EXEC ? "executable"
                                                     : "other kind of ELF file";
  OS << "architecture: trax\n"
     << "type: " << Type << format(", flags 0x%08x", unsigned(Header.e_flags))
     << (Header.e_flags == TRAX_EF_STACK_LOCAL    ? ": stack in local memory\n"
         : Header.e_flags == TRAX_EF_STACK_GLOBAL ? ": stack in global memory\n"
                                                  : "\n")
     << format("start address: 0x%08x\n", unsigned(Header.e_entry));
}

static void printSectionHeaders(const ElfFile &File, const ListingOptions &Options, raw_ostream &OS) {
  OS << "\nSections:\nIdx Name               Size     Address  Align Type\n";
  for (const Section &S : File.sections()) {
    if (!isSelected(S, Options))
      continue;
    OS << format("%3u ", S.Index) << left_justify(S.Name, 18) << format(" %08x %08x ", S.Size, S.Address)
       << format_decimal(S.Alignment, 5);
    if (S.Flags & ELF::SHF_ALLOC)
      OS << (S.isCode()                  ? " TEXT"
             : S.Type == ELF::SHT_NOBITS ? " BSS"
                                         : " DATA")
         << (S.isCode() || S.Flags & ELF::SHF_WRITE ? "" : ", READONLY");
    else if (S.Name.starts_with(".debug"))
      OS << " DEBUG";
    if (S.Flags & ELF::SHF_TLS)
      OS << ", THREAD LOCAL";
    if (S.Flags & ELF::SHF_COMPRESSED)
      OS << ", COMPRESSED";
    OS << '\n';
  }
}

static void printProgramHeaders(const ElfFile &File, raw_ostream &OS) {
  OS << "\nProgram headers:\n";
  for (const ELF::Elf32_Phdr &P : File.segments()) {
    if (P.p_type == ELF::PT_LOAD)
      OS << "LOAD      ";
    else
      OS << format("0x%08x", unsigned(P.p_type));
    OS << format(" offset 0x%08x address 0x%08x in file 0x%08x in memory 0x%08x align %u ", unsigned(P.p_offset),
                 unsigned(P.p_vaddr), unsigned(P.p_filesz), unsigned(P.p_memsz), unsigned(P.p_align))
       << (P.p_flags & ELF::PF_R ? 'r' : '-') << (P.p_flags & ELF::PF_W ? 'w' : '-')
       << (P.p_flags & ELF::PF_X ? 'x' : '-') << '\n';
  }
}

static StringRef place(const Symbol &S) {
  return S.Where                      ? S.Where->Name
         : S.Index == ELF::SHN_ABS    ? "*absolute*"
         : S.Index == ELF::SHN_COMMON ? "*common*"
         : S.Index == ELF::SHN_UNDEF  ? "*undefined*"
                                      : "*unknown*";
}

static void printSymbols(const ElfFile &File, raw_ostream &OS) {
  OS << "\nSymbols:\n";
  for (const Symbol &S : drop_begin(File.symbols(), File.symbols().empty() ? 0 : 1)) {
    char Binding = S.Binding == ELF::STB_LOCAL ? 'l' : S.Binding == ELF::STB_WEAK ? 'w' : 'g';
    char Type = S.Type == ELF::STT_FUNC      ? 'F'
                : S.Type == ELF::STT_OBJECT  ? 'O'
                : S.Type == ELF::STT_SECTION ? 'd'
                : S.Type == ELF::STT_FILE    ? 'f'
                : S.Type == ELF::STT_TLS     ? 'T'
                                             : ' ';
    OS << format("%08x %c%c ", S.Value, Binding, Type) << left_justify(place(S), 12) << format(" %6u ", S.Size);
    if (S.Visibility != ELF::STV_DEFAULT)
      OS << (S.Visibility == ELF::STV_HIDDEN     ? ".hidden "
             : S.Visibility == ELF::STV_INTERNAL ? ".internal "
                                                 : ".protected ");
    OS << S.Name << '\n';
  }
}

static void printRelocations(const ElfFile &File, const ListingOptions &Options, raw_ostream &OS) {
  for (const Section &S : File.sections()) {
    if (!isSelected(S, Options) || S.Relocations.empty())
      continue;
    OS << "\nRelocations for " << S.Name << ":\n";
    for (const Relocation &R : S.Relocations) {
      if (S.Address + uint64_t(R.Offset) < Options.Start || S.Address + uint64_t(R.Offset) >= Options.Stop)
        continue;
      OS << format("%08x ", R.Offset) << left_justify(relocationName(R.Type), 12) << ' ';
      printPlace(OS, R.Target ? R.Target->Name : "*absolute*", R.Addend);
      OS << '\n';
    }
  }
}

static void printContents(const ElfFile &File, const ListingOptions &Options, raw_ostream &OS) {
  for (const Section &S : File.sections()) {
    if (!isSelected(S, Options) || S.Contents.empty())
      continue;
    OS << "\nContents of " << S.Name << ":\n";
    for (size_t Begin = 0; Begin < S.Contents.size(); Begin += 16) {
      ArrayRef<uint8_t> Line = S.Contents.slice(Begin).take_front(16);
      OS << format("%08x", unsigned(S.Address + Begin));
      for (unsigned I = 0; I != 16; ++I) {
        if (I % 4 == 0)
          OS << ' ';
        if (I < Line.size())
          OS << format("%02x", Line[I]);
        else
          OS << "  ";
      }
      OS << "  ";
      for (uint8_t Byte : Line)
        OS << (Byte >= ' ' && Byte <= '~' ? char(Byte) : '.');
      OS << '\n';
    }
  }
}

Error trax::list(const Target &T, StringRef Name, StringRef Bytes, const ListingOptions &Options, raw_ostream &OS) {
  Expected<std::unique_ptr<ElfFile>> File = ElfFile::read(Bytes);
  if (!File)
    return File.takeError();
  for (const std::string &Wanted : Options.OnlySections)
    if (!(*File)->findSection(Wanted))
      return createStringError(inconvertibleErrorCode(), "has no section '" + Wanted + "'");
  OS << Name << ":\tfile format elf32-trax\n";
  if (Options.FileHeader)
    printFileHeader(**File, OS);
  if (Options.ProgramHeaders)
    printProgramHeaders(**File, OS);
  if (Options.SectionHeaders)
    printSectionHeaders(**File, Options, OS);
  if (Options.Symbols)
    printSymbols(**File, OS);
  if (Options.Relocations && !Options.Disassemble)
    printRelocations(**File, Options, OS);
  if (Options.Contents)
    printContents(**File, Options, OS);
  return Options.Disassemble ? disassemble(T, **File, Options, OS) : Error::success();
}
