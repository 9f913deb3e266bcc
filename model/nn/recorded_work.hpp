// Work whose kernels CUDA launches as one. Includes torch headers.
#pragma once

#include <ATen/core/Tensor.h>

#include <functional>
#include <memory>

namespace actformer::model {

/// A network of a few million weights keeps a GPU busy for microseconds a kernel, less than a launch takes. So the kernels of work that is done
/// again and again are recorded, and from then on launched together (a CUDA graph).
class RecordedWork {
  public:
    /// Records on a CUDA device where `wanted`; else run() calls the work every time.
    RecordedWork(const at::Device& device, bool wanted);
    ~RecordedWork();
    RecordedWork(const RecordedWork&) = delete;
    RecordedWork& operator=(const RecordedWork&) = delete;

    /// The same work every time, on tensors that stay where they are, without a wait for the device and without random numbers: what it
    /// reads and writes may change, its shapes and its numbers on the host do not. Throws c10::Error where CUDA cannot record it.
    void run(const std::function<void()>& work);

    bool records() const { return graph_ != nullptr; }

  private:
    struct Graph;
    std::unique_ptr<Graph> graph_;
};

}  // namespace actformer::model
