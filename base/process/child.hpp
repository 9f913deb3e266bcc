// A process that runs another program, started without a shell.
#pragma once

#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/process/interruption.hpp"

namespace actformer {

/// What becomes of a child when a signal comes that this process catches.
enum class OnSignal {
    end,   ///< it reaches the child too, as SIGTERM
    wait,  ///< it does not, nor does the terminal's Ctrl-C: what the child says is needed
};

/// It does not outlive this process.
class Child {
  public:
    using Environment = std::map<std::string, std::string>;

    /// Runs command[0] with the arguments that follow and with `more` in its environment. It reads nothing, and writes to the
    /// descriptors `out` and `errors`. Throws Error where no process can be made; a program that is not there gives exit code 127.
    Child(const std::vector<std::string>& command, int out, int errors, const Environment& more = {},
          OnSignal on_signal = OnSignal::end);
    /// Waits for it.
    ~Child();
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Its exit code, or 128 + the signal that ended it.
    int wait();

  private:
    pid_t pid_ = -1;
    std::optional<PassedOn> signals_;
    int exit_ = -1;
};

}  // namespace actformer
