#pragma once

#include <sys/wait.h>

#include <string>

namespace actformer::test {

struct CommandResult {
    int exit = -1;       ///< 128 and the signal's number where one ended it
    std::string output;  ///< standard output and error together
};

inline int exit_code_of(int status) {
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace actformer::test
