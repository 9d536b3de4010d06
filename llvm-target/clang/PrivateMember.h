//===- PrivateMember.h - the one trick -----------------------------------===//
//
// A target cannot be added to clang's libraries from outside: four members that in-tree code sets are private. The
// language lets an explicit instantiation name private members; Publish is one that hands the member's address out.
//
//   struct Rows { using Type = llvm::ArrayRef<Info> OptTable::*; friend Type addressOf(Rows); };
//   template struct Publish<Rows, &OptTable::OptionInfos>;
//   Table.*addressOf(Rows());
//
// Used for Driver::ToolChains (TraxToolChain.cpp), OptTable::OptionInfos (TraxOptions.cpp), TargetInfo::TargetOpts
// (TraxTargetInfo.cpp) and the lists of a Compilation's outputs (Main.cpp). A member that another release of LLVM
// renames fails the build.
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
