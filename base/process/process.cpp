#include "base/process/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/error.hpp"
#include "base/files/descriptor.hpp"
#include "base/process/child.hpp"

namespace actformer {
namespace {

/// The last line of what stands in the file from `start` on that is not empty. A bar that overwrites itself ends with \r.
std::string last_line(const std::filesystem::path& path, std::uintmax_t start) {
    std::ifstream file(path, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(start));
    std::string last;
    for (std::string line; std::getline(file, line);) {
        line = line.substr(line.rfind('\r') == std::string::npos ? 0 : line.rfind('\r') + 1);
        if (line.find_first_not_of(" \t\033[K") != std::string::npos) last = line;
    }
    return last;
}

}  // namespace

ProcessResult run_process(const std::vector<std::string>& command, const std::filesystem::path& log) {
    Descriptor file(::open(log.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0644));
    if (file.get() < 0) throw Error("{}: cannot be written: {}", log.string(), std::strerror(errno));
    std::error_code error;
    const auto start = std::filesystem::file_size(log, error);
    Child child(command, file.get(), file.get());
    file.close();
    const int exit = child.wait();
    return {exit, last_line(log, start)};
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
