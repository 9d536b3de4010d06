/* The list of the files that were read. No output may be one of them, and many of them become known late: a header that
   a source includes, a texture that a mesh refers to. So each input is noted when it is opened, and trax_output_open
   and trax_output_commit compare the output with all of them, by device, inode and change time.

   The list belongs to a program of this project, and to its children from fork. A program that starts others for one
   purpose, as the compiler starts the linker, shares its list with them. A program of others that uses the emulator as
   a library reads and writes what it likes, in any order: there is no list. */
#ifndef TRAX_READS_H
#define TRAX_READS_H

#include <stdbool.h>
#include <sys/stat.h>

#ifdef __cplusplus
extern "C" {
#endif

/* From now on there is a list. At the beginning of main. */
void trax_reads_begin(void);
/* Notes a file that was read, or that a simulated program has written. Devices, pipes and folders are ignored.
   trax_input_open and the list of trax/files.h call it for their files. */
void trax_reads_note(const struct stat *file);
/* Drops a file that the program itself has made and may make anew; its inode may be that of a file that was read and is
   gone. */
void trax_reads_drop(const struct stat *file);
void trax_reads_drop_path(const char *path);
bool trax_reads_has(const struct stat *file);
/* The programs that this process executes from now on use the same list. */
void trax_reads_share(void);

#ifdef __cplusplus
}
#endif
#endif
