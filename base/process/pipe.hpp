// What another program writes, read here. For base/process alone.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "base/error.hpp"
#include "base/files/descriptor.hpp"

namespace actformer {

struct Pipe {
    /// Throws Error where none can be made.
    Pipe() {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw Error("no pipe can be made: {}", std::strerror(errno));
        from = Descriptor(ends[0]);
        to = Descriptor(ends[1]);
    }

    /// Closes this process's writing end, then reads until all others have closed theirs.
    std::string read_all() {
        to.close();
        std::string all;
        std::array<char, 4096> piece;
        for (;;) {
            const auto got = ::read(from.get(), piece.data(), piece.size());
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) return all;
            all.append(piece.data(), static_cast<std::size_t>(got));
        }
    }

    Descriptor from, to;
};

}  // namespace actformer
