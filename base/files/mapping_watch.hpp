// A mapped file that another program cuts short: reading what is gone raises SIGBUS, for which there is no way back.
#pragma once

#include <csignal>

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace actformer {

/// While it lives, SIGBUS within the mapping ends the program with exit code 1 and one line, which names the file. Any other SIGBUS ends it by the signal.
class MappingWatch {
  public:
    MappingWatch() = default;
    MappingWatch(const void* memory, std::size_t bytes, const std::filesystem::path& file);
    ~MappingWatch();
    MappingWatch(MappingWatch&& other) noexcept;
    MappingWatch& operator=(MappingWatch&& other) noexcept;

  private:
    struct Mapping {
        const char* begin;
        std::size_t bytes;
        std::string line;
    };
    static void end_with_line(int signal, siginfo_t* what, void*);

    /// Those that are watched: a handler may neither wait for a lock nor allocate.
    static constexpr std::size_t most = 2048;  // twice the most --threads
    static std::atomic<const Mapping*> watched[most];

    std::unique_ptr<const Mapping> mapping_;
    std::atomic<const Mapping*>* place_ =
        nullptr;  ///< null where all places are taken, or there is nothing to watch
};

}  // namespace actformer
