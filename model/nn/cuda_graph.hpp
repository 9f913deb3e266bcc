// Work whose kernels CUDA launches as one. Includes torch headers.
#pragma once

#include <ATen/core/Tensor.h>

#include <functional>
#include <memory>

namespace actformer::model {

/// A network of a few million weights keeps a GPU busy for microseconds a kernel, less than a launch takes. So after some calls the kernels
/// of the work are captured as a CUDA graph, and from then on it is replayed.
class CudaGraph {
  public:
    static constexpr int warmup_calls = 3;

    /// Captures on CUDA devices, by a libtorch from 2.1 on that has CUDA, where `wanted`; else run() calls the work every time.
    CudaGraph(const at::Device& device, bool wanted);
    ~CudaGraph();
    CudaGraph(const CudaGraph&) = delete;
    CudaGraph& operator=(const CudaGraph&) = delete;

    /// `work` must be the same every time, on tensors that stay where they are: their values may change, but neither their shapes nor anything
    /// on the host. It must not wait for the device, copy from the host or draw random numbers on the device. Throws Error where CUDA cannot
    /// capture it.
    void run(const std::function<void()>& work);

  private:
    struct Capture;
    std::unique_ptr<Capture> capture_;
};

}  // namespace actformer::model
