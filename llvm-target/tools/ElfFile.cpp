//===- ElfFile.cpp - An ELF file for TRaX, read and checked --------------===//
#include "ElfFile.h"
#include "llvm/ADT/STLExtras.h"
#include "llvm/Object/Decompressor.h"
#include "llvm/Support/Endian.h"
#include "llvm/Support/MemoryBuffer.h"

using namespace llvm;
using namespace llvm::object;
using namespace trax;

static Error damaged(const Twine &Message) {
  return createStringError(inconvertibleErrorCode(), Message);
}

static Error inSection(unsigned Index, StringRef Name, Error E) {
  return damaged("section " + Twine(Index) + (Name.empty() ? "" : " (" + Name + ")") + ": " + toString(std::move(E)));
}

std::string trax::relocationName(uint32_t Type) {
  switch (Type) {
#define CASE(NAME, NUMBER)                                                                                             \
  case NUMBER:                                                                                                         \
    return #NAME;
    TRAX_RELOCATIONS(CASE)
#undef CASE
  default:
    return "R_TRAX_" + std::to_string(Type);
  }
}

Error ElfFile::readSections(const File &Elf) {
  auto Headers = Elf.sections();
  if (!Headers)
    return Headers.takeError();
  StringRef Names;
  if (!Headers->empty()) {
    auto Found = Elf.getSectionStringTable(*Headers);
    if (!Found)
      return damaged("section names: " + toString(Found.takeError()));
    Names = *Found;
  }
  uint32_t NextBase = 4096; // 0 is the base of symbols without a section
  for (const auto &[Index, Raw] : enumerate(*Headers)) {
    Section S{unsigned(Index),
              "",
              Raw.sh_type,
              Raw.sh_flags,
              Raw.sh_addr,
              Raw.sh_size,
              Raw.sh_offset,
              Raw.sh_addralign,
              {},
              {},
              {}};
    auto Name = Elf.getSectionName(Raw, Names);
    if (!Name)
      return inSection(Index, "", Name.takeError());
    S.Name = *Name;
    if (Index != 0 && S.Type != ELF::SHT_NOBITS) {
      auto Contents = Elf.getSectionContents(Raw);
      if (!Contents)
        return inSection(Index, S.Name, Contents.takeError());
      S.Contents = *Contents;
    }
    if (isRelocatable() && S.isCode()) {
      S.DebugBase = NextBase;
      NextBase += S.Size + 4096;
    }
    Sections.push_back(std::move(S));
  }
  return Error::success();
}

Error ElfFile::readSymbols(const File &Elf) {
  auto Headers = cantFail(Elf.sections());
  const File::Elf_Shdr *Table = nullptr;
  ArrayRef<File::Elf_Word> Extended;
  for (const auto &[Index, Raw] : enumerate(Headers)) {
    if (Raw.sh_type == ELF::SHT_SYMTAB) {
      if (Table)
        return damaged("section " + Twine(Index) + ": a second symbol table");
      Table = &Raw;
    } else if (Raw.sh_type == ELF::SHT_SYMTAB_SHNDX) {
      auto Found = Elf.getSHNDXTable(Raw);
      if (!Found)
        return inSection(Index, Sections[Index].Name, Found.takeError());
      Extended = *Found;
    }
  }
  if (!Table)
    return Error::success();
  unsigned TableIndex = Table - Headers.begin();
  auto Raw = Elf.symbols(Table);
  auto Names = Elf.getStringTableForSymtab(*Table);
  if (!Raw || !Names)
    return inSection(TableIndex, Sections[TableIndex].Name, joinErrors(Raw.takeError(), Names.takeError()));
  for (const File::Elf_Sym &Entry : *Raw) {
    Symbol S{"",
             Entry.st_value,
             Entry.st_size,
             Entry.getBinding(),
             Entry.getType(),
             Entry.getVisibility(),
             Entry.st_shndx,
             unsigned(Symbols.size()),
             nullptr};
    auto Name = Entry.getName(*Names);
    auto Where = Elf.getSectionIndex(Entry, *Raw, DataRegion<File::Elf_Word>(Extended));
    if (!Name || !Where)
      return damaged("symbol " + Twine(Symbols.size()) + ": " +
                     toString(joinErrors(Name.takeError(), Where.takeError())));
    S.Name = *Name;
    if (*Where >= Sections.size())
      return damaged("symbol " + Twine(Symbols.size()) + " (" + S.Name + "): is in section " + Twine(*Where) + " of " +
                     Twine(Sections.size()));
    if (*Where != 0) {
      S.Where = &Sections[*Where];
      if (S.Type == ELF::STT_SECTION && S.Name.empty())
        S.Name = S.Where->Name;
    }
    Symbols.push_back(S);
    if (S.Where && !S.Name.empty() && S.Type != ELF::STT_SECTION && S.Type != ELF::STT_FILE)
      Sections[*Where].Symbols.push_back(&Symbols.back());
  }
  for (Section &S : Sections)
    llvm::sort(S.Symbols, [](const Symbol *A, const Symbol *B) {
      return std::tie(A->Value, A->Number) < std::tie(B->Value, B->Number);
    });
  return Error::success();
}

Error ElfFile::readRelocations(const File &Elf) {
  for (const auto &[Index, Raw] : enumerate(cantFail(Elf.sections()))) {
    const Section &Table = Sections[Index];
    if (Raw.sh_type == ELF::SHT_REL)
      return damaged("section " + Twine(Index) + " (" + Table.Name + "): relocations without addends (SHT_REL)");
    if (Raw.sh_type != ELF::SHT_RELA)
      continue;
    auto Entries = Elf.relas(Raw);
    if (!Entries)
      return inSection(Index, Table.Name, Entries.takeError());
    if (Raw.sh_info == 0 || Raw.sh_info >= Sections.size())
      return damaged("section " + Twine(Index) + " (" + Table.Name + "): relocations for section " +
                     Twine(Raw.sh_info) + " of " + Twine(Sections.size()));
    Section &Target = Sections[Raw.sh_info];
    for (const File::Elf_Rela &Entry : *Entries) {
      uint32_t Number = Entry.getSymbol(false);
      if (Number != 0 && Number >= Symbols.size())
        return damaged("section " + Twine(Index) + " (" + Table.Name + "): relocation for symbol " + Twine(Number) +
                       " of " + Twine(Symbols.size()));
      Target.Relocations.push_back(
          {Entry.r_offset, Entry.getType(false), Number ? &Symbols[Number] : nullptr, Entry.r_addend});
    }
  }
  for (Section &S : Sections)
    llvm::sort(S.Relocations, [](const Relocation &A, const Relocation &B) {
      return std::tie(A.Offset, A.Type) < std::tie(B.Offset, B.Type);
    });
  return Error::success();
}

Expected<std::unique_ptr<ElfFile>> ElfFile::read(StringRef Bytes) {
  auto Result = std::make_unique<ElfFile>();
  if (uintptr_t(Bytes.data()) % 8 != 0) { // a member of an archive
    Result->Aligned = MemoryBuffer::getMemBufferCopy(Bytes);
    Bytes = Result->Aligned->getBuffer();
  }
  if (!Bytes.starts_with(StringRef(ELF::ElfMagic, 4)))
    return damaged("not an ELF file");
  if (Bytes.size() < sizeof(ELF::Elf32_Ehdr))
    return damaged("truncated: shorter than an ELF header");
  if (uint8_t(Bytes[ELF::EI_CLASS]) != ELF::ELFCLASS32 || uint8_t(Bytes[ELF::EI_DATA]) != ELF::ELFDATA2LSB)
    return damaged("not a 32-bit little-endian ELF file");
  memcpy(&Result->Header, Bytes.data(), sizeof Result->Header); // hosts are little endian, as Debian's LLVM is
  if (Result->Header.e_machine != TRAX_EM)
    return damaged("an ELF file for another machine (e_machine 0x" + Twine::utohexstr(Result->Header.e_machine) +
                   ", not 0x" + Twine::utohexstr(TRAX_EM) + ")");
  auto Elf = File::create(Bytes);
  if (!Elf)
    return Elf.takeError();
  if (Error E = Result->readSections(*Elf))
    return E;
  if (Error E = Result->readSymbols(*Elf))
    return E;
  if (Error E = Result->readRelocations(*Elf))
    return E;
  auto Segments = Elf->program_headers();
  if (!Segments)
    return damaged("program headers: " + toString(Segments.takeError()));
  for (const File::Elf_Phdr &Raw : *Segments)
    Result->Segments.push_back(
        {Raw.p_type, Raw.p_offset, Raw.p_vaddr, Raw.p_paddr, Raw.p_filesz, Raw.p_memsz, Raw.p_flags, Raw.p_align});
  return Result;
}

const Section *ElfFile::findSection(StringRef Name) const {
  auto Found = find_if(Sections, [Name](const Section &S) { return S.Name == Name; });
  return Found == Sections.end() ? nullptr : &*Found;
}

static Expected<std::vector<uint8_t>> decompress(const Section &S) {
  StringRef Packed(reinterpret_cast<const char *>(S.Contents.data()), S.Contents.size());
  auto Unpacker = Decompressor::create(S.Name, Packed, /*IsLE=*/true, /*Is64Bit=*/false);
  if (!Unpacker)
    return inSection(S.Index, S.Name, Unpacker.takeError());
  // zlib makes a byte of at most 1032; a header that promises much more is damaged, and not worth the memory.
  if (Unpacker->getDecompressedSize() / 2048 > Packed.size())
    return damaged("section " + Twine(S.Index) + " (" + S.Name + "): " + Twine(Packed.size()) +
                   " compressed bytes are said to hold " + Twine(Unpacker->getDecompressedSize()));
  std::vector<uint8_t> Bytes(Unpacker->getDecompressedSize());
  if (Error E = Unpacker->decompress(MutableArrayRef<uint8_t>(Bytes)))
    return inSection(S.Index, S.Name, std::move(E));
  return Bytes;
}

Expected<std::vector<uint8_t>> ElfFile::finalContents(const Section &S) const {
  std::vector<uint8_t> Bytes = S.Contents;
  if (S.Flags & ELF::SHF_COMPRESSED) {
    auto Unpacked = decompress(S);
    if (!Unpacked)
      return Unpacked.takeError();
    Bytes = std::move(*Unpacked);
  }
  for (const Relocation &R : S.Relocations) { // of debug information; instructions are not patched
    unsigned Width = R.Type == R_TRAX_32 || R.Type == R_TRAX_PC32 ? 4 : R.Type == R_TRAX_16 ? 2 : R.Type == R_TRAX_8;
    if (R.Offset > Bytes.size() || Bytes.size() - R.Offset < Width)
      return damaged("section " + Twine(S.Index) + " (" + S.Name + "): relocation at 0x" + Twine::utohexstr(R.Offset) +
                     " lies outside");
    uint32_t Base = R.Target && R.Target->Where ? R.Target->Where->DebugBase : 0;
    uint32_t Value =
        Base + (R.Target ? R.Target->Value : 0) + uint32_t(R.Addend) - (R.Type == R_TRAX_PC32 ? R.Offset : 0);
    for (unsigned I = 0; I != Width; ++I)
      Bytes[R.Offset + I] = Value >> 8 * I;
  }
  return Bytes;
}
