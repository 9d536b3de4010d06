struct point { float x, y; unsigned char tag; };
int helper(struct point *p, long long wide) { return (int)(p->x + p->y) + (int)(wide >> 3); }
