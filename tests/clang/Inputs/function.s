	.text
	.globl	function
	.type	function, @function
function:
	addi	r4, r0, 42
	jalr	r0, 0(r1)
	.size	function, . - function
