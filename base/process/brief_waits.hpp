// How the threads of libraries wait for work.
#pragma once

namespace actformer {

/// Threads that wait for work keep a processor busy, and on a machine with other work starve it and one another: training runs two to
/// four times slower. From here on OpenMP's spin for some ten microseconds, which is what most waits of a training step take, and then
/// sleep; OpenBLAS's sleep at once (2^4 cycles) in place of yielding for tens of milliseconds. The libraries read how to wait when they are
/// loaded, so this is for whoever starts the program that loads them. Where the environment says how, it is left alone.
void wait_briefly();

}  // namespace actformer
