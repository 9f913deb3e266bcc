// Memory of a device that is used again. Drivers that share the host's memory take it from the program's heap: large blocks that
// come and go among small ones would leave that in pieces, each too small for the next block.
#pragma once

#include <CL/opencl.hpp>
#include <deque>
#include <memory>
#include <mutex>

namespace actformer::kernels {

/// Calls may come from any thread.
class MemoryPool : public std::enable_shared_from_this<MemoryPool> {
  public:
    /// Buffers are of `largest` bytes at most.
    MemoryPool(cl::Context context, cl_mem_flags flags, std::size_t largest)
        : context_(std::move(context)), flags_(flags), largest_(largest) {}

    /// `bytes` of memory or some more, its content undefined. Comes back to the pool when the last copy of the pointer goes, in
    /// whatever thread. Commands of the device's one queue may still use it then: they come before those of its next user.
    /// Throws cl::Error where there is not enough.
    std::shared_ptr<const cl::Buffer> take(std::size_t bytes);

  private:
    struct Block {
        std::size_t bytes = 0;
        cl::Buffer memory;
    };

    Block found(std::size_t bytes);
    cl::Buffer allocated(std::size_t bytes);
    void give_back(Block block);

    cl::Context context_;
    cl_mem_flags flags_;
    std::size_t largest_;
    std::mutex mutex_;
    std::deque<Block> free_;  ///< the one that came back longest ago first
    std::size_t free_bytes_ = 0;
};

}  // namespace actformer::kernels
