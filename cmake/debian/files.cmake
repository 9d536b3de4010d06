# What a Debian package has and an installation has not. CPack runs it on the tree that it is about to pack.

set(root ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr)
set(doc ${root}/share/doc/trax)

file(REMOVE ${root}/bin/clang++ ${root}/bin/trax-clang ${root}/bin/trax-clang++)
file(RENAME ${root}/bin/clang ${root}/bin/trax-clang)
file(CREATE_LINK trax-clang ${root}/bin/trax-clang++ SYMBOLIC)

# Debian's Python finds the package there.
file(WRITE ${root}/lib/python3/dist-packages/trax.pth "/usr/lib/trax/python\n")

# Debian's LLVM is where every library is.
file(GLOB programs ${root}/bin/*)
foreach(program ${programs})
  file(READ ${program} magic LIMIT 4 HEX)
  if(magic STREQUAL 7f454c46 AND NOT IS_SYMLINK ${program})
    file(RPATH_REMOVE FILE ${program})
  endif()
endforeach()

# Without dates or names in what is compressed, so that the package is the same each time.
function(compress source target)
  execute_process(COMMAND gzip -9nc ${source} OUTPUT_FILE ${target} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
file(GLOB pages ${root}/share/man/man1/*.1)
foreach(page ${pages})
  compress(${page} ${page}.gz)
  file(REMOVE ${page})
endforeach()
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC) # SOURCE_DATE_EPOCH chooses another
file(WRITE ${doc}/changelog "trax (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium\n\n  * CHANGELOG.md.gz has what changed.\n\n"
  " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
compress(${doc}/changelog ${doc}/changelog.gz)
file(REMOVE ${doc}/changelog)
compress(${CPACK_TRAX_SOURCE}/CHANGELOG.md ${doc}/CHANGELOG.md.gz)

file(READ ${CPACK_TRAX_SOURCE}/LICENSE licence)
file(READ ${root}/lib/trax/COPYING.NEWLIB newlib)
file(WRITE ${doc}/copyright "trax\n\n${licence}\n\nThe mathematical functions of newlib in /usr/lib/trax/libc.a\n\n${newlib}\n\n"
  "newlib's notice names the GNU Lesser General Public License for parts that are not used here: /usr/share/common-licenses/LGPL.\n")

# Programs and objects for the TP are data here.
file(WRITE ${root}/share/lintian/overrides/trax
  "# Programs and libraries for the processors of the simulated chip.\n"
  "trax: binary-from-other-architecture [usr/lib/trax/*]\n"
  "trax: statically-linked-binary [usr/lib/trax/*]\n"
  "trax: unstripped-binary-or-object [usr/lib/trax/*]\n"
  "# Loading libpng would cost each run a sixth of what a short one takes.\n"
  "trax: embedded-library libpng [usr/bin/trax-sim]\n"
  "# For those who say -lm, -lpthread and the like: everything is in libc.a.\n"
  "trax: no-code-sections [usr/lib/trax/lib*.a]\n"
  "# newlib's notice is quoted whole. In newer releases it has the Apache license, of parts that are not used here.\n"
  "trax: copyright-file-contains-full-apache-2-license\n")
file(GLOB_RECURSE written ${doc}/* ${root}/share/lintian/* ${root}/share/man/* ${root}/lib/python3/*)
file(CHMOD ${written} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
