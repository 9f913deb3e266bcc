#include "base/process/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/error.hpp"
#include "base/files/descriptor.hpp"
#include "base/files/regular_file.hpp"
#include "base/process/pipe.hpp"

namespace actformer {
namespace {

/// A file that more is appended to.
class Log {
  public:
    explicit Log(const std::filesystem::path& path)
        : path_(path), file_(open_regular(path, O_CREAT | O_WRONLY | O_APPEND)) {
        if (file_.get() < 0) throw Error("{}: cannot be written: {}", path.string(), std::strerror(errno));
        std::error_code error;
        start_ = std::filesystem::file_size(path, error);
    }
    int descriptor() const { return file_.get(); }

    /// Of what was appended, that is not empty. A bar that overwrites itself ends with \r.
    std::string last_line() const {
        std::ifstream file(path_, std::ios::binary);
        file.seekg(static_cast<std::streamoff>(start_));
        std::string last;
        for (std::string line; std::getline(file, line);) {
            line = line.substr(line.rfind('\r') == std::string::npos ? 0 : line.rfind('\r') + 1);
            if (line.find_first_not_of(" \t\033[K") != std::string::npos) last = line;
        }
        return last;
    }

  private:
    std::filesystem::path path_;
    Descriptor file_;
    std::uintmax_t start_ = 0;
};

}  // namespace

ProcessResult run_process(const std::vector<std::string>& command, const std::filesystem::path& log) {
    const Log file(log);
    Child child(command, file.descriptor(), file.descriptor());
    const int exit = child.wait();
    return {exit, file.last_line()};
}

Answer answer_of(const std::vector<std::string>& command, const std::filesystem::path& log,
                 OnSignal on_signal) {
    const Log file(log);
    Pipe pipe;
    Child child(command, pipe.to.get(), file.descriptor(), {}, on_signal);
    auto output = pipe.read_all();
    const int exit = child.wait();
    return {exit, std::move(output), file.last_line()};
}

std::filesystem::path program_folder() {
    std::error_code error;
    return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

std::string command_line(const std::vector<std::string>& command) {
    std::string out;
    for (const auto& word : command) {
        if (!out.empty()) out += ' ';
        if (!word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                    "0123456789_-./=:,+@%") == std::string::npos) {
            out += word;
            continue;
        }
        out += '\'';
        for (const char c : word) c == '\'' ? out += "'\\''" : out += c;
        out += '\'';
    }
    return out;
}

}  // namespace actformer
