//===- ElfFile.h - An ELF file for TRaX, read and checked ----------------===//
#ifndef TRAX_TOOLS_ELFFILE_H
#define TRAX_TOOLS_ELFFILE_H

#include "trax/abi.h"
#include "llvm/ADT/SmallVector.h"
#include "llvm/ADT/StringRef.h"
#include "llvm/Object/ELF.h"
#include "llvm/Support/Error.h"
#include "llvm/Support/MemoryBuffer.h"
#include <deque>
#include <vector>

namespace trax {

struct Section;

struct Symbol {
  llvm::StringRef Name; ///< of a section's symbol, the section's
  uint32_t Value, Size;
  uint8_t Binding, Type, Visibility; ///< STB_*, STT_*, STV_*
  uint16_t Index;                    ///< st_shndx: SHN_UNDEF, SHN_ABS, SHN_COMMON or another
  unsigned Number;                   ///< in the table
  const Section *Where;              ///< nullptr if it is in none
};

struct Relocation {
  uint32_t Offset;      ///< in the section
  uint32_t Type;        ///< R_TRAX_*
  const Symbol *Target; ///< nullptr: the absolute 0
  int32_t Addend;
};

struct Section {
  unsigned Index;
  llvm::StringRef Name;
  uint32_t Type, Flags, Address, Size, Offset, Alignment;
  llvm::ArrayRef<uint8_t> Contents;    ///< as in the file; empty for SHT_NOBITS
  std::vector<Relocation> Relocations; ///< by offset
  std::vector<const Symbol *> Symbols; ///< those with a name in it, by address
  uint32_t DebugBase = 0;              ///< of code in an object, whose sections all begin at 0: apart from the others

  bool isCode() const { return Flags & llvm::ELF::SHF_EXECINSTR; }
};

/// Everything of a file that the tools print. Names and contents point into the file's bytes, which must outlive it.
class ElfFile {
public:
  /// Errors name the part that is damaged. The bytes may have any alignment.
  static llvm::Expected<std::unique_ptr<ElfFile>> read(llvm::StringRef Bytes);

  const llvm::ELF::Elf32_Ehdr &header() const { return Header; }
  bool isRelocatable() const { return Header.e_type == llvm::ELF::ET_REL; }
  const std::deque<Section> &sections() const { return Sections; } ///< [0] is the null section
  const std::deque<Symbol> &symbols() const { return Symbols; }    ///< [0] is the null symbol, where there is a table
  llvm::ArrayRef<llvm::ELF::Elf32_Phdr> segments() const { return Segments; }
  const Section *findSection(llvm::StringRef Name) const; ///< the first of the name, or nullptr

  /// The contents, decompressed and, in a relocatable file, with the relocations applied. A symbol of this file has its
  /// value, an offset in its section, plus the section's DebugBase; other symbols have 0.
  llvm::Expected<std::vector<uint8_t>> finalContents(const Section &S) const;

private:
  using File = llvm::object::ELFFile<llvm::object::ELF32LE>;
  llvm::Error readSections(const File &Elf);
  llvm::Error readSymbols(const File &Elf);
  llvm::Error readRelocations(const File &Elf);

  std::unique_ptr<llvm::MemoryBuffer> Aligned;
  llvm::ELF::Elf32_Ehdr Header;
  std::deque<Section> Sections;
  std::deque<Symbol> Symbols;
  std::vector<llvm::ELF::Elf32_Phdr> Segments;
};

enum RelocationType : uint32_t {
#define ENUMERATOR(NAME, NUMBER) NAME = NUMBER,
  TRAX_RELOCATIONS(ENUMERATOR)
#undef ENUMERATOR
};

/// "R_TRAX_HI16", or "R_TRAX_99" for a number that is none.
std::string relocationName(uint32_t Type);

} // namespace trax

#endif
