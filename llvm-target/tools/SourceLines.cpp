//===- SourceLines.cpp - Which line of the source an instruction is from -===//
//
// A reader of its own and not LLVM's DWARFContext: trax-objdump needs lines alone, of relocatable files too, and must
// bear whatever it is given.
//
//===----------------------------------------------------------------------===//
#include "SourceLines.h"
#include "llvm/ADT/STLExtras.h"
#include "llvm/ADT/StringMap.h"
#include "llvm/BinaryFormat/Dwarf.h"
#include "llvm/Support/DataExtractor.h"
#include "llvm/Support/Path.h"
#include <map>

using namespace llvm;
using namespace trax;

namespace {

/// A section's final bytes; empty if there is none of the name.
struct DebugSection {
  const Section *S = nullptr;
  std::vector<uint8_t> Bytes;

  DataExtractor data() const { return DataExtractor(Bytes, /*IsLittleEndian=*/true, /*AddressSize=*/4); }
};

/// How the entries of a DWARF 5 table of directories or files are made up: pairs of content type and form.
using EntryFormat = SmallVector<std::pair<uint64_t, uint64_t>, 4>;

struct FileEntry {
  StringRef Name;
  uint64_t Directory = 0;
};

struct Prologue {
  uint16_t Version = 0;
  uint64_t ProgramBegin = 0, End = 0;
  uint8_t MinimumInstruction = 1, LineRange = 1, OpcodeBase = 1;
  int8_t LineBase = 0;
  SmallVector<uint8_t, 12> OperandCounts; // by opcode - 1
  std::vector<StringRef> Directories;     // into the sections, like the names
  std::vector<FileEntry> Files;
};

} // namespace

namespace trax {

class LineReader {
public:
  LineReader(const ElfFile &Elf, SourceLines &Lines) : Elf(Elf), Lines(Lines) {}

  Error readAll(function_ref<void(Error)> Warning);

private:
  Error load(StringRef Name, DebugSection &Into);
  void readUnits();
  void readUnit(const DataExtractor &Info, uint64_t Offset, uint64_t End, uint64_t AbbrevOffset);
  Expected<StringRef> readForm(const DataExtractor &Data, DataExtractor::Cursor &C, uint64_t Form, uint64_t *Number,
                               int64_t Constant = 0) const;
  Error readTable(uint64_t Offset, uint64_t End);
  Error readOldNames(const DataExtractor &Data, DataExtractor::Cursor &C, Prologue &P) const;
  Error readNames(const DataExtractor &Data, DataExtractor::Cursor &C, bool AreFiles, Prologue &P) const;
  Error runProgram(const Prologue &P, uint64_t Offset);
  const Section *relocatedTo(uint64_t Offset) const;
  uint32_t fileIndex(const Prologue &P, uint64_t Number);
  void endSequence(size_t FirstRow, const Section *Where, uint32_t End);

  const ElfFile &Elf;
  SourceLines &Lines;
  DebugSection Line, Strings, LineStrings, Info, Abbrev;
  std::map<uint64_t, StringRef> CompilationDirectories; // by offset of the line table
  StringRef CompilationDirectory;                       // of the current table
  StringMap<uint32_t> FileIndices;
  std::map<uint64_t, uint32_t> TableFiles; // of the current table: number in it -> index in Lines.Files
};

} // namespace trax

static Error damaged(uint64_t Offset, const Twine &Message) {
  return createStringError(inconvertibleErrorCode(),
                           ".debug_line: table at 0x" + Twine::utohexstr(Offset) + ": " + Message);
}

Error LineReader::load(StringRef Name, DebugSection &Into) {
  Into.S = Elf.findSection(Name);
  if (!Into.S)
    return Error::success();
  auto Bytes = Elf.finalContents(*Into.S);
  if (!Bytes)
    return Bytes.takeError();
  Into.Bytes = std::move(*Bytes);
  return Error::success();
}

/// A string, as a string; a number, through Number. Neither, of a form that holds something else: its bytes are
/// skipped.
Expected<StringRef> LineReader::readForm(const DataExtractor &Data, DataExtractor::Cursor &C, uint64_t Form,
                                         uint64_t *Number, int64_t Constant) const {
  auto InSection = [](const DebugSection &Section, uint64_t Offset) { return Section.data().getCStrRef(&Offset); };
  uint64_t Value = 0;
  switch (Form) {
  case dwarf::DW_FORM_string:
    return Data.getCStrRef(C);
  case dwarf::DW_FORM_strp:
    return InSection(Strings, Data.getU32(C));
  case dwarf::DW_FORM_line_strp:
    return InSection(LineStrings, Data.getU32(C));
  case dwarf::DW_FORM_data1:
  case dwarf::DW_FORM_flag:
  case dwarf::DW_FORM_strx1:
  case dwarf::DW_FORM_addrx1:
    Value = Data.getU8(C);
    break;
  case dwarf::DW_FORM_data2:
  case dwarf::DW_FORM_strx2:
  case dwarf::DW_FORM_addrx2:
    Value = Data.getU16(C);
    break;
  case dwarf::DW_FORM_data4:
  case dwarf::DW_FORM_sec_offset:
  case dwarf::DW_FORM_addr:
  case dwarf::DW_FORM_strx4:
  case dwarf::DW_FORM_addrx4:
    Value = Data.getU32(C);
    break;
  case dwarf::DW_FORM_data8:
    Value = Data.getU64(C);
    break;
  case dwarf::DW_FORM_udata:
  case dwarf::DW_FORM_strx:
  case dwarf::DW_FORM_addrx:
  case dwarf::DW_FORM_loclistx:
  case dwarf::DW_FORM_rnglistx:
    Value = Data.getULEB128(C);
    break;
  case dwarf::DW_FORM_sdata:
    Value = uint64_t(Data.getSLEB128(C));
    break;
  case dwarf::DW_FORM_data16:
    Data.skip(C, 16);
    break;
  case dwarf::DW_FORM_block:
  case dwarf::DW_FORM_exprloc:
    Data.skip(C, Data.getULEB128(C));
    break;
  case dwarf::DW_FORM_block1:
    Data.skip(C, Data.getU8(C));
    break;
  case dwarf::DW_FORM_flag_present:
    break;
  case dwarf::DW_FORM_implicit_const:
    Value = uint64_t(Constant);
    break;
  default:
    return createStringError(inconvertibleErrorCode(), "unknown form 0x" + Twine::utohexstr(Form));
  }
  if (Number)
    *Number = Value;
  return StringRef();
}

/// The first entry of a unit says where it was compiled and which line table is its. Units that cannot be read only
/// cost the directory.
void LineReader::readUnit(const DataExtractor &Data, uint64_t Offset, uint64_t End, uint64_t AbbrevOffset) {
  DataExtractor Unit(Data.getData().take_front(End), true, 4), Abbrevs = Abbrev.data();
  DataExtractor::Cursor C(Offset), A(AbbrevOffset);
  uint64_t Wanted = Unit.getULEB128(C), Code;
  while (A && (Code = Abbrevs.getULEB128(A)) != 0) {
    Abbrevs.getULEB128(A); // tag
    Abbrevs.getU8(A);      // children
    StringRef Directory;
    std::optional<uint64_t> Table;
    while (A) {
      uint64_t Attribute = Abbrevs.getULEB128(A), Form = Abbrevs.getULEB128(A), Number = 0;
      int64_t Constant = Form == dwarf::DW_FORM_implicit_const ? Abbrevs.getSLEB128(A) : 0;
      if (!A || (Attribute == 0 && Form == 0))
        break;
      if (Code != Wanted)
        continue;
      Expected<StringRef> Text = readForm(Unit, C, Form, &Number, Constant);
      if (!Text) {
        consumeError(Text.takeError());
        break;
      }
      if (Attribute == dwarf::DW_AT_comp_dir)
        Directory = *Text;
      else if (Attribute == dwarf::DW_AT_stmt_list && C)
        Table = Number;
    }
    if (Code == Wanted) {
      if (Table)
        CompilationDirectories[*Table] = Directory;
      break;
    }
  }
  consumeError(C.takeError());
  consumeError(A.takeError());
}

void LineReader::readUnits() {
  DataExtractor Data = Info.data();
  for (uint64_t Offset = 0; Offset < Info.Bytes.size();) {
    DataExtractor::Cursor C(Offset);
    uint64_t Length = Data.getU32(C), End = C.tell() + Length;
    uint16_t Version = Data.getU16(C);
    uint64_t AbbrevOffset;
    if (Version >= 5) {
      Data.getU8(C); // kind of unit
      Data.getU8(C); // size of an address
      AbbrevOffset = Data.getU32(C);
    } else {
      AbbrevOffset = Data.getU32(C);
      Data.getU8(C);
    }
    uint64_t Begin = C.tell();
    End = std::min<uint64_t>(End, Info.Bytes.size());
    bool Good = bool(C) && Version >= 2 && Version <= 5 && Length < dwarf::DW_LENGTH_lo_reserved && Begin <= End &&
                AbbrevOffset <= Abbrev.Bytes.size(); // LEB128 numbers are read without a look at where they begin
    consumeError(C.takeError());
    if (!Good)
      return;
    readUnit(Data, Begin, End, AbbrevOffset);
    Offset = End;
  }
}

Error LineReader::readOldNames(const DataExtractor &Data, DataExtractor::Cursor &C, Prologue &P) const {
  P.Directories.push_back(CompilationDirectory);
  for (StringRef Name; C && !(Name = Data.getCStrRef(C)).empty();)
    P.Directories.push_back(Name);
  P.Files.emplace_back(); // numbers begin at 1
  for (StringRef Name; C && !(Name = Data.getCStrRef(C)).empty();) {
    P.Files.push_back({Name, Data.getULEB128(C)});
    Data.getULEB128(C); // time
    Data.getULEB128(C); // length
  }
  return Error::success();
}

Error LineReader::readNames(const DataExtractor &Data, DataExtractor::Cursor &C, bool AreFiles, Prologue &P) const {
  EntryFormat Format;
  for (unsigned I = Data.getU8(C); C && I != 0; --I) {
    uint64_t Content = Data.getULEB128(C), Form = Data.getULEB128(C);
    Format.push_back({Content, Form});
  }
  uint64_t Count = Data.getULEB128(C);
  if (C && Count > P.End - C.tell()) // every entry takes a byte or more
    return createStringError(inconvertibleErrorCode(), Twine(Count) + " names do not fit");
  for (; C && Count != 0; --Count) {
    FileEntry Entry;
    for (const auto &[Content, Form] : Format) {
      uint64_t Number = 0;
      Expected<StringRef> Text = readForm(Data, C, Form, &Number);
      if (!Text)
        return Text.takeError();
      if (Content == dwarf::DW_LNCT_path)
        Entry.Name = *Text;
      else if (Content == dwarf::DW_LNCT_directory_index)
        Entry.Directory = Number;
    }
    if (AreFiles)
      P.Files.push_back(Entry);
    else
      P.Directories.push_back(Entry.Name);
  }
  return Error::success();
}

uint32_t LineReader::fileIndex(const Prologue &P, uint64_t Number) {
  auto [Known, IsNew] = TableFiles.try_emplace(Number, 0);
  if (!IsNew)
    return Known->second;
  SmallString<128> Path;
  if (Number < P.Files.size() && !P.Files[Number].Name.empty()) {
    const FileEntry &Entry = P.Files[Number];
    if (!sys::path::is_absolute(Entry.Name)) {
      if (Entry.Directory < P.Directories.size())
        Path = P.Directories[Entry.Directory];
      if (!sys::path::is_absolute(Path)) {
        SmallString<128> Base(CompilationDirectory);
        if (!Path.equals(CompilationDirectory))
          sys::path::append(Base, Path);
        Path = Base;
      }
    }
    sys::path::append(Path, Entry.Name);
    sys::path::remove_dots(Path);
  } else {
    Path = "??";
  }
  auto [At, IsNewName] = FileIndices.try_emplace(Path, Lines.Files.size());
  if (IsNewName)
    Lines.Files.push_back(Path.str().str());
  return Known->second = At->second;
}

const Section *LineReader::relocatedTo(uint64_t Offset) const {
  const std::vector<Relocation> &Relocations = Line.S->Relocations;
  auto Found = partition_point(Relocations, [Offset](const Relocation &R) { return R.Offset < Offset; });
  return Found != Relocations.end() && Found->Offset == Offset && Found->Target ? Found->Target->Where : nullptr;
}

void LineReader::endSequence(size_t FirstRow, const Section *Where, uint32_t End) {
  size_t Count = Lines.Rows.size() - FirstRow;
  auto Begin = Lines.Rows.begin() + FirstRow;
  bool Rises = is_sorted(make_range(Begin, Lines.Rows.end()),
                         [](const auto &A, const auto &B) { return A.Address < B.Address; });
  // In an object, a sequence without a relocation is of code that is not there.
  if (Count == 0 || !Rises || End <= Begin->Address || (Elf.isRelocatable() && !Where))
    Lines.Rows.resize(FirstRow);
  else
    Lines.Sequences.push_back({Elf.isRelocatable() ? Where : nullptr, Begin->Address, End, FirstRow, Count});
}

Error LineReader::runProgram(const Prologue &P, uint64_t Offset) {
  DataExtractor Data = Line.data();
  DataExtractor::Cursor C(P.ProgramBegin);
  const Section *Where = nullptr;
  uint32_t Address = 0, Number = 1;
  uint64_t File = 1;
  size_t FirstRow = Lines.Rows.size();
  auto AddRow = [&] { Lines.Rows.push_back({Address, fileIndex(P, File), Number}); };
  auto Advance = [&](uint64_t Operations) { Address += uint32_t(Operations) * P.MinimumInstruction; };

  while (C && C.tell() < P.End) {
    uint8_t Opcode = Data.getU8(C);
    if (Opcode >= P.OpcodeBase) {
      uint8_t Adjusted = Opcode - P.OpcodeBase;
      Advance(Adjusted / P.LineRange);
      Number += P.LineBase + Adjusted % P.LineRange;
      AddRow();
      continue;
    }
    switch (Opcode) {
    case 0: {
      uint64_t Length = Data.getULEB128(C), Begin = C.tell();
      uint8_t Extended = Length ? Data.getU8(C) : 0;
      if (!C)
        break;
      if (Length > P.End - Begin)
        return joinErrors(C.takeError(), damaged(Offset, "an extended opcode ends behind the table"));
      if (Extended == dwarf::DW_LNE_end_sequence) {
        endSequence(FirstRow, Where, Address);
        FirstRow = Lines.Rows.size();
        Where = nullptr;
        Address = 0;
        Number = File = 1;
      } else if (Extended == dwarf::DW_LNE_set_address && Length == 5) {
        Where = relocatedTo(C.tell());
        Address = Data.getU32(C);
      }
      C.seek(Begin + Length); // others, such as discriminators, do not matter here
      break;
    }
    case dwarf::DW_LNS_copy:
      AddRow();
      break;
    case dwarf::DW_LNS_advance_pc:
      Advance(Data.getULEB128(C));
      break;
    case dwarf::DW_LNS_advance_line:
      Number += uint32_t(Data.getSLEB128(C));
      break;
    case dwarf::DW_LNS_set_file:
      File = Data.getULEB128(C);
      break;
    case dwarf::DW_LNS_const_add_pc:
      Advance((255 - P.OpcodeBase) / P.LineRange);
      break;
    case dwarf::DW_LNS_fixed_advance_pc:
      Address += Data.getU16(C);
      break;
    default: // columns, statements, opcodes of later versions
      for (unsigned I = P.OperandCounts[Opcode - 1]; I != 0; --I)
        Data.getULEB128(C);
      break;
    }
  }
  Lines.Rows.resize(FirstRow); // of a sequence without an end
  return C.takeError();
}

Error LineReader::readTable(uint64_t Offset, uint64_t End) {
  Prologue P;
  P.End = End;
  // No read goes beyond the table.
  DataExtractor Data(Line.data().getData().take_front(End), true, 4);
  DataExtractor::Cursor C(Offset + 4);
  P.Version = Data.getU16(C);
  if (C && (P.Version < 2 || P.Version > 5))
    return joinErrors(C.takeError(), damaged(Offset, "unknown version " + Twine(P.Version)));
  if (P.Version >= 5)
    Data.skip(C, 2); // sizes of address and segment selector
  uint64_t Length = Data.getU32(C);
  P.ProgramBegin = C.tell() + Length;
  P.MinimumInstruction = Data.getU8(C);
  if (P.Version >= 4)
    Data.getU8(C); // operations of an instruction
  Data.getU8(C);   // whether rows are statements at first
  P.LineBase = int8_t(Data.getU8(C));
  P.LineRange = Data.getU8(C);
  P.OpcodeBase = Data.getU8(C);
  for (unsigned I = 1; C && I < P.OpcodeBase; ++I)
    P.OperandCounts.push_back(Data.getU8(C));
  if (!C)
    return C.takeError();
  if (P.LineRange == 0 || P.OpcodeBase == 0 || P.ProgramBegin > End)
    return joinErrors(C.takeError(), damaged(Offset, "its header is damaged"));
  CompilationDirectory = CompilationDirectories[Offset];
  TableFiles.clear();
  if (P.Version < 5) {
    if (Error E = readOldNames(Data, C, P))
      return joinErrors(C.takeError(), std::move(E));
  } else {
    if (Error E = readNames(Data, C, /*AreFiles=*/false, P))
      return joinErrors(C.takeError(), std::move(E));
    if (Error E = readNames(Data, C, /*AreFiles=*/true, P))
      return joinErrors(C.takeError(), std::move(E));
    if (!P.Directories.empty() && sys::path::is_absolute(P.Directories[0]))
      CompilationDirectory = P.Directories[0];
  }
  if (Error E = C.takeError())
    return E;
  return runProgram(P, Offset);
}

Error LineReader::readAll(function_ref<void(Error)> Warning) {
  for (auto [Name, Into] : {std::pair<const char *, DebugSection *>{".debug_line", &Line},
                            {".debug_str", &Strings},
                            {".debug_line_str", &LineStrings},
                            {".debug_info", &Info},
                            {".debug_abbrev", &Abbrev}})
    if (Error E = load(Name, *Into))
      return E;
  readUnits();
  DataExtractor Data = Line.data();
  for (uint64_t Offset = 0; Offset < Line.Bytes.size();) {
    uint64_t At = Offset;
    uint64_t Length = Line.Bytes.size() - Offset < 4 ? dwarf::DW_LENGTH_lo_reserved : Data.getU32(&At);
    if (Length >= dwarf::DW_LENGTH_lo_reserved || Length > Line.Bytes.size() - At) {
      Warning(damaged(Offset, "it ends behind the section"));
      break;
    }
    if (Error E = readTable(Offset, At + Length))
      Warning(std::move(E));
    Offset = At + Length;
  }
  auto Order = [](const auto &Q) { return std::make_tuple(Q.Where ? Q.Where->Index : 0, Q.Begin, Q.FirstRow); };
  llvm::sort(Lines.Sequences, [&](const auto &A, const auto &B) { return Order(A) < Order(B); });
  return Error::success();
}

Expected<SourceLines> SourceLines::read(const ElfFile &File, function_ref<void(Error)> Warning) {
  SourceLines Lines;
  if (Error E = LineReader(File, Lines).readAll(Warning))
    return E;
  return Lines;
}

const SourceLines::Row *SourceLines::find(const Section &S, uint32_t Address) const {
  auto Behind = partition_point(Sequences, [&](const Sequence &Q) {
    unsigned Index = Q.Where ? Q.Where->Index : 0, Wanted = Q.Where ? S.Index : 0;
    return Index < Wanted || (Index == Wanted && Q.Begin <= Address);
  });
  if (Behind == Sequences.begin())
    return nullptr;
  const Sequence &Q = *std::prev(Behind);
  if ((Q.Where && Q.Where != &S) || Address < Q.Begin || Address >= Q.End)
    return nullptr;
  ArrayRef<Row> Range = ArrayRef(Rows).slice(Q.FirstRow, Q.RowCount);
  return &*std::prev(partition_point(Range, [Address](const Row &R) { return R.Address <= Address; }));
}
