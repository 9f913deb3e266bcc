// A program that is a library beside it, PROGRAM.so, opened so that nobody else sees what it and its own libraries export.
#include <dlfcn.h>

#include <cstdio>
#include <filesystem>
#include <system_error>

int main(int argc, char** argv) {
    std::error_code unread;
    const auto rest = std::filesystem::read_symlink("/proc/self/exe", unread).string() + ".so";
    void* const library = ::dlopen(rest.c_str(), RTLD_NOW | RTLD_LOCAL);
    using Main = int(int, char**);
    auto* const main_of_it = library ? reinterpret_cast<Main*>(::dlsym(library, "main")) : nullptr;
    if (main_of_it) return main_of_it(argc, argv);
    std::fprintf(stderr, "actformer: %s; build or install it again\n", ::dlerror());
    return 1;
}
