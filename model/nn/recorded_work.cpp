#include "model/nn/recorded_work.hpp"

#ifdef ACTFORMER_CUDA
#include <ATen/cuda/CUDAGraph.h>
#include <c10/cuda/CUDAGuard.h>
#endif

namespace actformer::model {

#ifdef ACTFORMER_CUDA

struct RecordedWork::Graph {
    /// Libraries make their handles, workspaces and choices in the first calls.
    static constexpr int plain_calls = 3;

    explicit Graph(const at::Device& device)
        : stream(c10::cuda::getStreamFromPool(/*isHighPriority=*/false,
                                              device.has_index() ? device.index() : c10::DeviceIndex{-1})) {}

    void run(const std::function<void()>& work) {
        if (calls > plain_calls) return graph.replay();
        c10::cuda::getCurrentCUDAStream(stream.device_index()).synchronize();
        {
            const c10::cuda::CUDAStreamGuard guard(stream);  // CUDA records no default stream
            if (calls == plain_calls)
                record(work);
            else
                work();
            ++calls;
        }
        stream.synchronize();
        if (calls > plain_calls) graph.replay();
    }

    void record(const std::function<void()>& work) {
        // Of this thread alone: NCCL's asks CUDA all the time how far its work is.
        graph.capture_begin({0, 0}, cudaStreamCaptureModeThreadLocal);
        work();
        graph.capture_end();
    }

    c10::cuda::CUDAStream stream;
    at::cuda::CUDAGraph graph;
    int calls = 0;
};

RecordedWork::RecordedWork(const at::Device& device, bool wanted) {
    if (wanted && device.is_cuda()) graph_ = std::make_unique<Graph>(device);
}

#else

struct RecordedWork::Graph {
    void run(const std::function<void()>& work) { work(); }
};

RecordedWork::RecordedWork(const at::Device& /*device*/, bool /*wanted*/) {}

#endif

RecordedWork::~RecordedWork() = default;

void RecordedWork::run(const std::function<void()>& work) {
    graph_ ? graph_->run(work) : work();
}

}  // namespace actformer::model
