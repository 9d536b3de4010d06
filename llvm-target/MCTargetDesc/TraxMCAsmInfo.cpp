//===- TraxMCAsmInfo.cpp - Assembly syntax -------------------------------===//
#include "TraxMCAsmInfo.h"

using namespace llvm;

TraxMCAsmInfo::TraxMCAsmInfo(const Triple &) {
  IsLittleEndian = true;
  CodePointerSize = 4;
  CalleeSaveStackSlotSize = 4;
  CommentString = "#";
  AlignmentIsInBytes = false;
  MinInstAlignment = 4;
  Data16bitsDirective = "\t.half\t";
  Data32bitsDirective = "\t.word\t";
  Data64bitsDirective = "\t.dword\t";
  ZeroDirective = "\t.zero\t";
  SupportsDebugInformation = true;
  ExceptionsType = ExceptionHandling::DwarfCFI; // call-frame information for debuggers; there are no exceptions
  UsesELFSectionDirectiveForBSS = true;
}
