//===- SourceLines.cpp - The source line of an instruction ---------------===//
#include "SourceLines.h"
#include "llvm/ADT/STLExtras.h"
#include "llvm/DebugInfo/DWARF/DWARFCompileUnit.h"
#include <map>
#include <tuple>

using namespace llvm;
using namespace trax;

Expected<SourceLines> SourceLines::read(const ElfFile &File, function_ref<void(Error)> Warning) {
  SourceLines Lines;
  for (const Section &S : File.sections()) {
    StringRef Name = S.Name;
    if (!Name.consume_front(".") || !Name.starts_with("debug_") || Lines.Contents.count(Name))
      continue;
    Expected<std::vector<uint8_t>> Bytes = File.finalContents(S);
    if (!Bytes)
      return Bytes.takeError();
    Lines.Contents[Name] =
        MemoryBuffer::getMemBufferCopy(StringRef(reinterpret_cast<char *>(Bytes->data()), Bytes->size()));
  }

  Lines.Context =
      DWARFContext::create(Lines.Contents, /*AddrSize=*/4, /*isLittleEndian=*/true, consumeError, consumeError);
  DWARFContext &Context = *Lines.Context;
  std::map<uint64_t, const char *> Directories; // by offset of the line table
  for (const std::unique_ptr<DWARFUnit> &Unit : Context.compile_units())
    if (auto Table = dwarf::toSectionOffset(Unit->getUnitDIE().find(dwarf::DW_AT_stmt_list)))
      Directories[*Table] = Unit->getCompilationDir();

  // All tables of the section: one that an assembler made may have no unit.
  DWARFDataExtractor Data(Context.getDWARFObj(), Context.getDWARFObj().getLineSection(), /*IsLittleEndian=*/true, 4);
  DWARFDebugLine::SectionParser Parser(Data, Context, Context.normal_units());
  while (!Parser.done()) {
    const char *Directory = Directories[Parser.getOffset()];
    Lines.Tables.push_back(Parser.parseNext(Warning, Warning));
    for (const DWARFDebugLine::Sequence &S : Lines.Tables.back().Sequences)
      Lines.Sequences.push_back(
          {S.LowPC, S.HighPC, &Lines.Tables.back(), Directory ? Directory : "", Lines.Sequences.size()});
  }
  llvm::sort(Lines.Sequences, [](const Sequence &A, const Sequence &B) {
    return std::tie(A.Begin, A.Number) < std::tie(B.Begin, B.Number);
  });
  return Lines;
}

std::optional<SourceLines::Place> SourceLines::find(const Section &S, uint32_t Address) const {
  const uint64_t Wanted = Address + S.DebugBase;
  auto Behind = partition_point(Sequences, [&](const Sequence &Q) { return Q.Begin <= Wanted; });
  if (Behind == Sequences.begin())
    return std::nullopt;
  const Sequence &Q = *std::prev(Behind);
  const uint32_t Row = Wanted < Q.End ? Q.Table->lookupAddress({Wanted, object::SectionedAddress::UndefSection})
                                      : Q.Table->UnknownRowIndex;
  if (Row == Q.Table->UnknownRowIndex)
    return std::nullopt;
  Place Found{"??", Q.Table->Rows[Row].Line};
  Q.Table->getFileNameByIndex(Q.Table->Rows[Row].File, Q.Directory,
                              DILineInfoSpecifier::FileLineInfoKind::AbsoluteFilePath, Found.File);
  return Found;
}
