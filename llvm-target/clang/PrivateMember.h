//===- PrivateMember.h - access to private members of clang's classes -----===//
//
// Three members that clang's own targets set are private (docs/llvm-releases.md says why they are needed). An explicit
// instantiation may name private members. Publish is one that returns the member's address.
//
//   struct Rows { using Type = llvm::ArrayRef<Info> OptTable::*; friend Type addressOf(Rows); };
//   template struct Publish<Rows, &OptTable::OptionInfos>;
//   Table.*addressOf(Rows());
//
// Used for Driver::ToolChains (TraxToolChain.cpp), OptTable::OptionInfos (TraxOptions.cpp) and TargetInfo::TargetOpts
// (TraxTargetInfo.cpp). If another release of LLVM renames a member, the build fails.
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_CLANG_PRIVATEMEMBER_H
#define TRAX_CLANG_PRIVATEMEMBER_H

namespace trax {

template <typename Name, typename Name::Type Member> struct Publish {
  friend typename Name::Type addressOf(Name) { return Member; }
};

} // namespace trax

#endif
