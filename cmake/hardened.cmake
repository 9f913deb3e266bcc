# What makes a slip with memory end the program instead of handing it to whoever wrote the file that it reads: a guard on the stack,
# checked copies of the C library's functions (they need an optimising compiler), addresses that differ from run to run, and tables of
# addresses that are complete at the start and cannot be written after. Sanitizers bring their own checks, and do not go with these.
option(ACTFORMER_HARDENED "Build with the compiler's and the linker's protections" ON)
if(ACTFORMER_HARDENED AND NOT ACTFORMER_SANITIZE)
  add_compile_options(-fstack-protector-strong $<$<CONFIG:Release,RelWithDebInfo>:-U_FORTIFY_SOURCE> $<$<CONFIG:Release,RelWithDebInfo>:-D_FORTIFY_SOURCE=2>)
  add_link_options($<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-pie> -Wl,-z,relro,-z,now)
endif()
