//===- FileCalls.h - Inputs and outputs of LLVM and clang ----------------===//
//
// LLVM and clang open their outputs in some thirty places, each for another option, and compare none of them with the
// inputs. All of them call open and rename of the C library. FileCalls.cpp replaces these functions, so that the one
// rule of outputs (trax/output.h) holds for every option:
//   - a file that is opened for reading is noted as an input;
//   - a file that is opened for writing under its own name is collected in memory, and written by commitOutputs;
//   - a file that gets its name by rename after it was written is written by trax_write_whole.
// commitOutputs reports failures, not the call. The functions of emulator/base, which write by that rule, use renameat
// and unlinkat, which are not replaced.
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_FILES_FILECALLS_H
#define TRAX_FILES_FILECALLS_H

namespace trax {

/// Whether the rule is followed from now on (initially: yes). For other targets clang behaves as it does elsewhere:
/// its modules, for example, are inputs and outputs.
void followRule(bool Follow);

/// The last file that was opened for writing.
const void *outputsSoFar();

/// Writes the files collected since Since, unless the program has failed (Keep is false), and reports those that cannot
/// be written as "PROGRAM: error: ...". Returns false if there was any.
bool commitOutputs(const char *Program, bool Keep, const void *Since = nullptr);

} // namespace trax

#endif
