/* The interface between the files that handle GDB's packets. */
#ifndef TRAX_GDB_COMMANDS_H
#define TRAX_GDB_COMMANDS_H

#include "gdb/stub.h"

/* Error numbers of replies: errno's, which GDB prints. */
enum { TRAX_GDB_BAD_REQUEST = 22, TRAX_GDB_BAD_ADDRESS = 14, TRAX_GDB_NO_THREAD = 3, TRAX_GDB_NO_MEMORY = 12 };

enum { TRAX_GDB_ANY_THREAD = 0, TRAX_GDB_ALL_THREADS = -1 }; /* thread ids of packets */

/* --- commands.c --- */
/* Sends a reply: a text, an error number, or OK if `done` and else the error number. */
void trax_gdb_answer(struct trax_gdb *gdb, const char *text);
void trax_gdb_refuse(struct trax_gdb *gdb, unsigned number);
void trax_gdb_confirm(struct trax_gdb *gdb, bool done, unsigned number);

/* Each reads an argument and moves *text past it. False: it is not there. */
bool trax_gdb_starts_with(const char **text, const char *prefix);
bool trax_gdb_read_thread(const struct trax_gdb *gdb, const char **text, int64_t *id);
bool trax_gdb_read_range(const char **text, uint32_t *address, size_t *size);

/* --- resume.c --- */
void trax_gdb_continue(struct trax_gdb *gdb, const char *text, bool step, bool with_signal);
void trax_gdb_verbose(struct trax_gdb *gdb, const char *text);

/* --- queries.c --- */
void trax_gdb_query(struct trax_gdb *gdb, const char *text);
void trax_gdb_set(struct trax_gdb *gdb, const char *text);

#endif
