#define RESULT 42
	.text
	.globl	function
	.type	function, @function
function:
	addi	r4, r0, RESULT // a comment of the preprocessor's
#ifdef __trax__
	jalr	r0, 0(r1)
#endif
	.size	function, . - function
