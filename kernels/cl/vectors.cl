// Vectors of VEC floats (1, 2, 4, 8 or 16); this file is put before those that use them.

#if VEC == 1
#define VECTOR float
#define LOAD(index, from) ((from)[index])
#define STORE(value, index, to) ((to)[index] = (value))
#else
#define GLUE_(a, b) a##b
#define GLUE(a, b) GLUE_(a, b)
#define VECTOR GLUE(float, VEC)
#define LOAD GLUE(vload, VEC)
#define STORE GLUE(vstore, VEC)
#endif
