// Which signals no thread takes of itself.
#pragma once

namespace actformer {

/// From here on this thread, those it makes and the program that it becomes leave SIGINT, SIGTERM, SIGHUP, SIGPIPE and SIGXFSZ
/// pending. Libraries make threads while they are loaded (OpenBLAS does), before main() can ask for anything: where they are to leave
/// signals alone too, whoever starts the program asks for it.
void block_signals();

}  // namespace actformer
