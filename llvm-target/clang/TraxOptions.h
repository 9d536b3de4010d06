//===- TraxOptions.h - the options that clang does not have --------------===//
//
// -mstack=, -mstack-size= and -ffixed-rN are rows at the end of clang's own table. So they are parsed, completed,
// explained by --help, read from configuration files and written by -MJ like all others.
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_CLANG_TRAXOPTIONS_H
#define TRAX_CLANG_TRAXOPTIONS_H

#include "clang/Driver/Options.h"

namespace trax {

namespace options {
enum ID : unsigned { OPT_mstack_EQ = clang::driver::options::LastOption, OPT_mstack_size_EQ, OPT_ffixed_r };
} // namespace options

/// Adds the rows to the driver's table. Called once, before a Driver parses anything.
void addOptions();

} // namespace trax

#endif
