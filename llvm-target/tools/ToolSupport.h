//===- ToolSupport.h - Common parts of the command-line tools ------------===//
//
// These tools take the options of LLVM's tools of the same kind, so options (cl::opt), messages and files are LLVM's
// and not those of emulator/base; outputs are base's.
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_TOOLS_TOOLSUPPORT_H
#define TRAX_TOOLS_TOOLSUPPORT_H

#include "llvm/ADT/ArrayRef.h"
#include "llvm/ADT/StringRef.h"
#include "llvm/ADT/Twine.h"

namespace llvm {
class raw_ostream;
class Target;
} // namespace llvm

namespace trax {

/// Registers the target, parses the command line ("Overview" heads the help), and sets up "TOOL: error: ..." messages.
/// Exits on bad arguments.
const llvm::Target &startTool(int Argc, char **Argv, llvm::StringRef Overview);

/// Reports "TOOL: error: MESSAGE" and exits with status 1.
[[noreturn]] void fail(const llvm::Twine &Message);

/// Fails if one of the inputs is the output. Called before any work; what is included is compared when it is written.
void checkFiles(llvm::ArrayRef<std::string> Inputs, const std::string &Output);

/// Puts the bytes into the file by the rule of trax/output.h; "-" is the standard output.
void writeOutput(const std::string &File, llvm::StringRef Bytes);

/// The exit status, after LLVM's own outputs (FileCalls.h).
int endTool(int Status);

} // namespace trax

#endif
