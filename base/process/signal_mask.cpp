#include "base/process/signal_mask.hpp"

#include <signal.h>

#include <initializer_list>

namespace actformer {

void block_signals() {
    sigset_t set;
    ::sigemptyset(&set);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) ::sigaddset(&set, signal);
    ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

}  // namespace actformer
