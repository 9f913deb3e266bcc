// How fast a method trains and generates on this machine. Knows nothing of torch.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace actformer::model {

struct MethodSpeedRequest {
    std::string method = "actformer";
    std::vector<std::string> overrides;                                ///< of its configuration, key=value
    std::uint32_t persons = 1, classes = 94, frames = 60, batch = 64;  ///< limbs of NTU's joints
    int threads = 0;                                                   ///< 0: as many as the process may use
};

/// Seconds by the clock, and of processors, all threads together; the best of all rounds, each by itself.
struct Seconds {
    double wall = 0, processors = 0;
};

class MethodSpeed {
  public:
    /// Sets the threads of libtorch. Throws Error for a method or a configuration that cannot be.
    explicit MethodSpeed(const MethodSpeedRequest& request);
    ~MethodSpeed();

    /// Runs a step of training and the generation of 100 motions `rounds` times more.
    void run(int rounds);

    const Seconds& step() const;
    const Seconds& generation() const;
    const std::string& machine() const;  ///< libtorch, threads and products a second, in a line
    std::string device() const;          ///< of libtorch, where it trains and generates

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace actformer::model
