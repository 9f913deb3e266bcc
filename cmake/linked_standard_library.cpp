// Prints the file of the system's C++ standard library where this program was linked with an archive of one instead.
#include <dlfcn.h>
#include <link.h>

#include <iostream>

int main() {
#ifdef __GLIBCXX__
    if (dlopen("libstdc++.so.6", RTLD_LAZY | RTLD_NOLOAD)) return 0;
    void* const system = dlopen("libstdc++.so.6", RTLD_LAZY);
    link_map* where = nullptr;
    if (system && dlinfo(system, RTLD_DI_LINKMAP, &where) == 0) std::cout << where->l_name;
#endif
}
