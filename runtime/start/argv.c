/* argv of a program without arguments: a null pointer. The compiler refers to it where main uses argv; elsewhere crt0
   passes a null pointer. It is in local memory, since crt0 has one instruction for its address. */
extern _Thread_local char *__trax_argv[1];
_Thread_local char *__trax_argv[1];
