// Loads the library of actformer-train once, and does commands by its main() in processes split off from there. A message at descriptor 3
// holds, each ended by a zero: the folder to work in, how many words, the words, the environment; and with it comes the descriptor to
// print to. The answer is the status that waitpid() gives.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "base/process/process.hpp"
#include "base/process/signal_mask.hpp"

namespace {

constexpr int requests = 3;

using Main = int(int, char**);

/// The texts of the next request; none after the last.
std::vector<char*> next(std::vector<char>& message, int& output) {
    iovec bytes{message.data(), message.size()};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof output)]{};
    msghdr header{};
    header.msg_iov = &bytes;
    header.msg_iovlen = 1;
    header.msg_control = control;
    header.msg_controllen = sizeof control;
    const auto size = ::recvmsg(requests, &header, 0);
    const auto* const rights = CMSG_FIRSTHDR(&header);
    if (size <= 0 || !rights) return {};
    std::memcpy(&output, CMSG_DATA(rights), sizeof output);
    std::vector<char*> texts;
    for (char* text = message.data(); text < message.data() + size; text += std::strlen(text) + 1)
        texts.push_back(text);
    return texts;
}

[[noreturn]] void do_command(Main* main_of_it, std::vector<char*> texts, int output) {
    ::close(requests);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::close(output);
    if (::chdir(texts[0]) != 0) ::_exit(127);
    const auto words = std::strtoul(texts[1], nullptr, 10);
    std::vector<char*> arguments{const_cast<char*>("actformer")};
    arguments.insert(arguments.end(), texts.begin() + 2,
                     texts.begin() + 2 + static_cast<std::ptrdiff_t>(words));
    arguments.push_back(nullptr);
    ::clearenv();
    for (auto i = words + 2; i < texts.size(); ++i) ::putenv(texts[i]);
    const int code = main_of_it(static_cast<int>(words) + 1, arguments.data());
    std::fflush(nullptr);
    std::_Exit(code);  // libtorch's own end takes longer than many a command
}

}  // namespace

int main() {
    actformer::block_signals();  // as whoever starts actformer-train does
    ::fcntl(requests, F_SETFD, FD_CLOEXEC);
    const auto path = actformer::program_folder() / "actformer-train.so";
    void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    auto* const main_of_it = library ? reinterpret_cast<Main*>(::dlsym(library, "main")) : nullptr;
    if (!main_of_it) {
        std::fprintf(stderr, "warm_training: %s\n", ::dlerror());
        return 1;
    }
    std::vector<char> message(1 << 20);
    int output = -1;
    for (auto texts = next(message, output); !texts.empty(); texts = next(message, output)) {
        const auto pid = ::fork();
        if (pid == 0) do_command(main_of_it, texts, output);
        ::close(output);
        int status = 127 << 8;
        if (pid > 0) ::waitpid(pid, &status, 0);
        if (::send(requests, &status, sizeof status, MSG_NOSIGNAL) < 0) break;
    }
}
