#include "model/nn/cuda_graph.hpp"

#ifdef ACTFORMER_CUDA_GRAPHS
#include <ATen/cuda/CUDAGraph.h>
#include <c10/cuda/CUDAGuard.h>

#include "base/error.hpp"
#include "model/nn/one_line.hpp"
#endif

namespace actformer::model {

#ifdef ACTFORMER_CUDA_GRAPHS

struct CudaGraph::Capture {
    explicit Capture(const at::Device& device)
        : stream(c10::cuda::getStreamFromPool(
              /*isHighPriority=*/false, device.has_index() ? device.index() : c10::DeviceIndex{-1})) {}

    /// Libraries make their handles, workspaces and choices in the first calls.
    void run(const std::function<void()>& work) {
        if (calls > warmup_calls) return graph.replay();
        c10::cuda::getCurrentCUDAStream(stream.device_index()).synchronize();
        {
            const c10::cuda::CUDAStreamGuard guard(stream);  // CUDA captures no default stream
            if (calls == warmup_calls)
                capture(work);
            else
                work();
            ++calls;
        }
        stream.synchronize();
        if (calls > warmup_calls) graph.replay();
    }

    void capture(const std::function<void()>& work) try {
        // Of this thread alone: NCCL's watchdog polls CUDA events at any time.
        graph.capture_begin({0, 0}, cudaStreamCaptureModeThreadLocal);
        work();
        graph.capture_end();
    } catch (const c10::Error& e) {
        throw Error("libtorch: no CUDA graph could be captured: {}; cuda_graphs=false trains without",
                    one_line(e));
    }

    c10::cuda::CUDAStream stream;
    at::cuda::CUDAGraph graph;
    int calls = 0;
};

CudaGraph::CudaGraph(const at::Device& device, bool wanted) {
    if (wanted && device.is_cuda()) capture_ = std::make_unique<Capture>(device);
}

#else

struct CudaGraph::Capture {
    void run(const std::function<void()>& work) { work(); }
};

CudaGraph::CudaGraph(const at::Device& /*device*/, bool /*wanted*/) {}

#endif

CudaGraph::~CudaGraph() = default;

void CudaGraph::run(const std::function<void()>& work) {
    capture_ ? capture_->run(work) : work();
}

}  // namespace actformer::model
