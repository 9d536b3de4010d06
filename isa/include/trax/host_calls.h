/* Numbers of the trap `host`, shared by the C library and the emulator; docs/abi.md, "Host calls", says what they mean.
   Plain macros: included by C and assembly. */
#ifndef TRAX_HOST_CALLS_H
#define TRAX_HOST_CALLS_H

/* The words of the block at the trap's operand: the call's number, which its result replaces, and its arguments. */
#define TRAX_HOST_WORDS 6

/* Host calls: ID, number, meaning with the arguments in the order of the block. */
#define TRAX_HOST_CALLS(X)                                                                                             \
  X(OPEN, 1, "path, flags: opens a file; a descriptor")                                                                \
  X(CLOSE, 2, "descriptor")                                                                                            \
  X(READ, 3, "descriptor, address, bytes: the bytes read, 0 at the end")                                               \
  X(WRITE, 4, "descriptor, address, bytes: the bytes written")                                                         \
  X(SEEK, 5, "descriptor, address of the offset in 8 bytes, which receive the new one, origin")                        \
  X(STAT, 6, "path, address of a struct trax_host_stat, whether a symbolic link is followed")                          \
  X(FSTAT, 7, "descriptor, address of a struct trax_host_stat")                                                        \
  X(TRUNCATE, 8, "descriptor, address of the size in 8 bytes")                                                         \
  X(TERMINAL, 9, "descriptor: 1 if it is a terminal, else 0")                                                          \
  X(REMOVE, 10, "path of a file")                                                                                      \
  X(RENAME, 11, "path, new path")                                                                                      \
  X(MAKE_FOLDER, 12, "path")                                                                                           \
  X(REMOVE_FOLDER, 13, "path")                                                                                         \
  X(LIST, 14, "path of a folder, address, bytes: the length of the list; nothing is written if that is more")          \
  X(DUPLICATE, 15, "descriptor, number, whether it is exactly that one or the lowest free from there: the other one")  \
  X(FOLDER, 16, "descriptor of a folder, address, bytes: the length of its path with a NUL; as LIST")

#define TRAX_HOST_OPEN 1
#define TRAX_HOST_CLOSE 2
#define TRAX_HOST_READ 3
#define TRAX_HOST_WRITE 4
#define TRAX_HOST_SEEK 5
#define TRAX_HOST_STAT 6
#define TRAX_HOST_FSTAT 7
#define TRAX_HOST_TRUNCATE 8
#define TRAX_HOST_TERMINAL 9
#define TRAX_HOST_REMOVE 10
#define TRAX_HOST_RENAME 11
#define TRAX_HOST_MAKE_FOLDER 12
#define TRAX_HOST_REMOVE_FOLDER 13
#define TRAX_HOST_LIST 14
#define TRAX_HOST_DUPLICATE 15
#define TRAX_HOST_FOLDER 16

/* Flags of TRAX_HOST_OPEN: one of the first three, and others added. */
#define TRAX_OPEN_READ 0
#define TRAX_OPEN_WRITE 1
#define TRAX_OPEN_BOTH 2
#define TRAX_OPEN_APPEND 0x8
#define TRAX_OPEN_CREATE 0x200
#define TRAX_OPEN_TRUNCATE 0x400
#define TRAX_OPEN_NEW 0x800        /* with TRAX_OPEN_CREATE: the file must not exist */
#define TRAX_OPEN_NO_LINK 0x100000 /* a symbolic link as the last part is an error */
#define TRAX_OPEN_FOLDER 0x200000  /* only a folder */

/* Origins of TRAX_HOST_SEEK. */
#define TRAX_SEEK_BEGIN 0
#define TRAX_SEEK_HERE 1
#define TRAX_SEEK_END 2

/* struct trax_host_stat: words. */
#define TRAX_STAT_MODE 0 /* TRAX_MODE_... and the permissions of the owner */
#define TRAX_STAT_SIZE 1 /* and the next word: bytes */
#define TRAX_STAT_FILE 3 /* and the next word: differs between files that exist at the same time */
#define TRAX_STAT_WORDS 5
#define TRAX_MODE_FILE 0100000
#define TRAX_MODE_FOLDER 0040000
#define TRAX_MODE_LINK 0120000
#define TRAX_MODE_OTHER 0020000 /* a terminal, a pipe */

/* Error numbers are those of Linux. This one is the result of an unknown call. */
#define TRAX_HOST_NO_CALL 38

#endif
