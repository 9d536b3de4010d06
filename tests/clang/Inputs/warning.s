	.warning "careful"
