//===- SourceLines.h - Which line of the source an instruction is from ---===//
#ifndef TRAX_TOOLS_SOURCELINES_H
#define TRAX_TOOLS_SOURCELINES_H

#include "ElfFile.h"
#include <string>

namespace trax {

/// The line tables of a file (.debug_line, DWARF 2 to 5), by address.
class SourceLines {
public:
  struct Row {
    uint32_t Address; ///< in an object: offset in the section
    uint32_t File;    ///< index for file()
    uint32_t Line;    ///< 0: the instructions belong to no line
  };

  /// A file without debug information has no lines. What is damaged ends a table; Warning hears of it, what was read
  /// before stays.
  static llvm::Expected<SourceLines> read(const ElfFile &File, llvm::function_ref<void(llvm::Error)> Warning);

  /// The row for the instruction, or nullptr. In an executable every section has the same addresses.
  const Row *find(const Section &S, uint32_t Address) const;
  const std::string &file(uint32_t Index) const { return Files[Index]; }

private:
  friend class LineReader;

  /// Rows of rising addresses; the last one ends it.
  struct Sequence {
    const Section *Where; ///< nullptr in an executable
    uint32_t Begin, End;
    size_t FirstRow, RowCount;
  };
  std::vector<std::string> Files;
  std::vector<Row> Rows;
  std::vector<Sequence> Sequences; ///< by Where and Begin
};

} // namespace trax

#endif
