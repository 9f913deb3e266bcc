#include "tests/support/warm_training.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>
#include <wordexp.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "base/process/brief_waits.hpp"
#include "tests/support/paths.hpp"

namespace actformer::test {
namespace {

using Words = std::vector<std::string>;

/// As a shell reads them, where it has nothing to do but to split them.
Words split(const std::string& line) {
    wordexp_t read{};
    if (::wordexp(line.c_str(), &read, WRDE_NOCMD) != 0) return {};
    Words words(read.we_wordv, read.we_wordv + read.we_wordc);
    ::wordfree(&read);
    return words;
}

bool is_done_by_training(const Words& words) {
    if (words.empty()) return false;
    if (words[0] == "score") return std::ranges::find(words, "--generator") != words.end();
    return words[0] == "train" || words[0] == "generate" || words[0] == "import" || words[0] == "model";
}

/// The process (tests/support/warm_training_server.cpp), from the first call to the end of the tests.
class Server {
  public:
    Server() {
        int ends[2];
        if (!std::filesystem::exists(warm_training()) ||
            ::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
            return;
        socket_ = ends[0];
        pid_ = ::fork();
        if (pid_ != 0) {
            ::close(ends[1]);
            return;
        }
        wait_briefly();  // as the program says to actformer-train
        ::dup2(ends[1], 3);
        ::fcntl(3, F_SETFD, 0);  // where it was 3 already
        ::execl(warm_training().c_str(), warm_training().c_str(), nullptr);
        ::_exit(127);
    }
    ~Server() {
        if (socket_ < 0) return;
        ::close(socket_);
        if (pid_ > 0) ::waitpid(pid_, nullptr, 0);
    }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Has the words done there, in this process's folder and environment, what is printed going to `output`.
    bool send(const Words& words, int output) {
        if (socket_ < 0) return false;
        std::string message =
            std::filesystem::current_path().string() + '\0' + std::to_string(words.size()) + '\0';
        for (const auto& word : words) message += word + '\0';
        for (char** variable = environ; *variable; ++variable) message += std::string(*variable) + '\0';
        iovec bytes{message.data(), message.size()};
        alignas(cmsghdr) char control[CMSG_SPACE(sizeof output)]{};
        msghdr header{};
        header.msg_iov = &bytes;
        header.msg_iovlen = 1;
        header.msg_control = control;
        header.msg_controllen = sizeof control;
        auto* const rights = CMSG_FIRSTHDR(&header);
        rights->cmsg_level = SOL_SOCKET;
        rights->cmsg_type = SCM_RIGHTS;
        rights->cmsg_len = CMSG_LEN(sizeof output);
        std::copy_n(reinterpret_cast<const char*>(&output), sizeof output, CMSG_DATA(rights));
        return ::sendmsg(socket_, &header, MSG_NOSIGNAL) == static_cast<ssize_t>(message.size());
    }

    int status() {
        int status = 127 << 8;
        return ::recv(socket_, &status, sizeof status, 0) == sizeof status ? status : 127 << 8;
    }

  private:
    int socket_ = -1;
    pid_t pid_ = 0;
};

}  // namespace

std::optional<CommandResult> run_in_warm_training(const std::string& arguments) {
    const auto words = split(arguments);
    if (!is_done_by_training(words)) return {};
    static Server server;
    int output[2];
    if (::pipe2(output, O_CLOEXEC) != 0) return {};
    const bool sent = server.send(words, output[1]);
    ::close(output[1]);
    CommandResult result;
    char buffer[4096];
    if (sent)
        for (ssize_t n; (n = ::read(output[0], buffer, sizeof buffer)) > 0;)
            result.output.append(buffer, static_cast<std::size_t>(n));
    ::close(output[0]);
    if (!sent) return {};
    result.exit = exit_code_of(server.status());
    return result;
}

}  // namespace actformer::test
