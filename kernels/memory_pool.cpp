#include "kernels/memory_pool.hpp"

#include <algorithm>
#include <bit>

namespace actformer::kernels {
namespace {

constexpr std::size_t smallest_kept = std::size_t{1} << 20;  // smaller blocks find a place in any heap
constexpr std::size_t most_kept = std::size_t{256} << 20;    // bytes that nobody uses

/// Of eight sizes between one power of two and the next: blocks of nearly the same size serve each other.
std::size_t rounded_up(std::size_t bytes) {
    const auto step = std::bit_floor(bytes) / 8;
    return (bytes + step - 1) / step * step;
}

}  // namespace

std::shared_ptr<const cl::Buffer> MemoryPool::take(std::size_t bytes) {
    if (bytes < smallest_kept) return std::make_shared<const cl::Buffer>(context_, flags_, bytes);
    // NVIDIA's driver gives out buffers that it has no memory for, and fails where they are used.
    if (bytes > largest_) throw cl::Error(CL_INVALID_BUFFER_SIZE);
    const auto wanted = std::min(rounded_up(bytes), largest_);
    auto block = found(wanted);
    if (!block.memory()) block = {wanted, allocated(wanted)};
    const auto lease = std::make_shared<Block>(std::move(block));
    return {&lease->memory,
            [pool = shared_from_this(), lease](auto*) { pool->give_back(std::move(*lease)); }};
}

/// Where memory runs out, what nobody uses goes first.
cl::Buffer MemoryPool::allocated(std::size_t bytes) {
    try {
        return {context_, flags_, bytes};
    } catch (const cl::Error&) {
        const std::lock_guard lock(mutex_);
        if (free_.empty()) throw;
        free_.clear();
        free_bytes_ = 0;
    }
    return {context_, flags_, bytes};
}

/// One of just that size; none where there is none.
MemoryPool::Block MemoryPool::found(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    const auto it =
        std::find_if(free_.begin(), free_.end(), [&](const Block& block) { return block.bytes == bytes; });
    if (it == free_.end()) return {};
    auto block = std::move(*it);
    free_.erase(it);
    free_bytes_ -= bytes;
    return block;
}

void MemoryPool::give_back(Block block) {
    const std::lock_guard lock(mutex_);
    free_bytes_ += block.bytes;
    free_.push_back(std::move(block));
    while (free_bytes_ > most_kept) {
        free_bytes_ -= free_.front().bytes;
        free_.pop_front();
    }
}

}  // namespace actformer::kernels
