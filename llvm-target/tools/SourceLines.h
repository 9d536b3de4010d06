//===- SourceLines.h - The source line of an instruction -----------------===//
#ifndef TRAX_TOOLS_SOURCELINES_H
#define TRAX_TOOLS_SOURCELINES_H

#include "ElfFile.h"
#include "llvm/DebugInfo/DWARF/DWARFContext.h"
#include <string>

namespace trax {

/// The line tables of a file (.debug_line), by address.
class SourceLines {
public:
  struct Place {
    std::string File;
    uint32_t Line; ///< 0: the instruction belongs to no line
  };

  /// A file without debug information has no lines. Damaged tables are reported to Warning, and the rest is read.
  static llvm::Expected<SourceLines> read(const ElfFile &File, llvm::function_ref<void(llvm::Error)> Warning);

  /// In an object, the address is an offset in the section; in an executable every section has the same addresses.
  std::optional<Place> find(const Section &S, uint32_t Address) const;

private:
  struct Sequence {
    uint64_t Begin, End;
    const llvm::DWARFDebugLine::LineTable *Table;
    const char *Directory; ///< where the unit was compiled
    size_t Number;         ///< in the order of the file
  };
  llvm::StringMap<std::unique_ptr<llvm::MemoryBuffer>> Contents; ///< of the sections, by name without the dot
  std::unique_ptr<llvm::DWARFContext> Context;                   ///< refers to them
  std::deque<llvm::DWARFDebugLine::LineTable> Tables;
  std::vector<Sequence> Sequences; ///< by Begin and Number
};

} // namespace trax

#endif
