/* There are no processes to wait for. */
#ifndef TRAX_SYS_WAIT_H
#define TRAX_SYS_WAIT_H

#include <sys/types.h>
#include <trax/names.h>

#define WNOHANG 1
#define WUNTRACED 2
#define WIFEXITED(status) (((status) & 127) == 0)
#define WEXITSTATUS(status) ((status) >> 8 & 255)
#define WIFSIGNALED(status) (((status) & 127) != 0)
#define WTERMSIG(status) ((status) & 127)

__TRAX_FAILS(pid_t, wait, (int *status), -1)
__TRAX_FAILS(pid_t, waitpid, (pid_t process, int *status, int options), -1)

#endif
