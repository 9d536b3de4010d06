//===- ArchiveFile.h - The members of an ar archive ----------------------===//
#ifndef TRAX_TOOLS_ARCHIVEFILE_H
#define TRAX_TOOLS_ARCHIVEFILE_H

#include "llvm/ADT/STLFunctionalExtras.h"
#include "llvm/ADT/StringRef.h"
#include "llvm/Support/Error.h"

namespace trax {

bool isArchive(llvm::StringRef Bytes);

/// Calls Use for each member, except the index and the table of names, until it fails. GNU and BSD format. (LLVM's
/// reader reads a member's header before it checks the end of the file.)
llvm::Error forEachMember(llvm::StringRef Bytes,
                          llvm::function_ref<llvm::Error(llvm::StringRef Name, llvm::StringRef Contents)> Use);

} // namespace trax

#endif
