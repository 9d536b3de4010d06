//===- ArchiveFile.cpp - The members of an ar archive --------------------===//
#include "ArchiveFile.h"

using namespace llvm;

static constexpr StringLiteral Magic = "!<arch>\n", ThinMagic = "!<thin>\n";
static constexpr size_t HeaderSize = 60;

bool trax::isArchive(StringRef Bytes) {
  return Bytes.starts_with(Magic) || Bytes.starts_with(ThinMagic);
}

static Error damaged(size_t Offset, const Twine &Message) {
  return createStringError(inconvertibleErrorCode(), "archive member at offset " + Twine(Offset) + ": " + Message);
}

Error trax::forEachMember(StringRef Bytes, function_ref<Error(StringRef, StringRef)> Use) {
  if (Bytes.starts_with(ThinMagic))
    return createStringError(inconvertibleErrorCode(), "a thin archive (make a regular one: llvm-ar without T)");
  StringRef LongNames;
  for (size_t Offset = Magic.size(); Offset < Bytes.size();) {
    StringRef Header = Bytes.substr(Offset, HeaderSize);
    size_t Size;
    if (Header.size() < HeaderSize)
      return damaged(Offset, "truncated: " + Twine(Header.size()) + " bytes are left for its header");
    if (!Header.ends_with("`\n") || Header.substr(48, 10).rtrim(' ').getAsInteger(10, Size))
      return damaged(Offset, "its header is damaged");
    StringRef Contents = Bytes.drop_front(Offset + HeaderSize);
    if (Size > Contents.size())
      return damaged(Offset, "truncated: " + Twine(Size) + " bytes, " + Twine(Contents.size()) + " are left");
    Contents = Contents.take_front(Size);

    StringRef Field = Header.take_front(16).rtrim(' '), Name;
    size_t Number;
    bool IsIndex = Field == "/" || Field == "/SYM64/" || Field.starts_with("__.SYMDEF");
    if (Field == "//") {
      LongNames = Contents;
      IsIndex = true;
    } else if (Field.starts_with("#1/")) { // BSD: the name is in front of the contents
      if (Field.drop_front(3).getAsInteger(10, Number) || Number > Contents.size())
        return damaged(Offset, "its name is damaged");
      Name = Contents.take_front(Number).rtrim('\0');
      Contents = Contents.drop_front(Number);
      IsIndex = Name.starts_with("__.SYMDEF");
    } else if (Field.starts_with("/") && !IsIndex) { // GNU: the place of a long name, which ends with "/\n"
      if (Field.drop_front().getAsInteger(10, Number) || Number >= LongNames.size())
        return damaged(Offset, "its name is damaged");
      Name = LongNames.drop_front(Number).take_until([](char C) { return C == '\n'; }).rtrim('/');
    } else {
      Name = Field.rtrim('/');
    }
    if (!IsIndex)
      if (Error E = Use(Name, Contents))
        return E;
    Offset += HeaderSize + Size + (Size & 1);
  }
  return Error::success();
}
