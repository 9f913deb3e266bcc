#include "model/train/processes.hpp"

#include <ATen/core/grad_mode.h>
#include <chrono>

#include "base/error.hpp"
#include "model/nn/one_line.hpp"

#if defined(ACTFORMER_GLOO) || defined(ACTFORMER_NCCL)
#define ACTFORMER_C10D
#include <torch/csrc/distributed/c10d/PrefixStore.hpp>
#include <torch/csrc/distributed/c10d/TCPStore.hpp>
#endif
#ifdef ACTFORMER_GLOO
#include <torch/csrc/distributed/c10d/ProcessGroupGloo.hpp>
#endif
#ifdef ACTFORMER_NCCL
#include <torch/csrc/distributed/c10d/ProcessGroupNCCL.hpp>
#endif

namespace actformer::model {

#ifdef ACTFORMER_C10D

namespace {

/// Of work that a group does: Gloo's and NCCL's classes have a common base in libtorch 2 only, and it is another in 1.
struct Collective {
    virtual ~Collective() = default;
    virtual void all_reduce_sum(std::vector<at::Tensor>& values) = 0;
    virtual void broadcast(std::vector<at::Tensor>& values) = 0;
};

template <typename Backend>
struct Through final : Collective {
    explicit Through(c10::intrusive_ptr<Backend> made) : backend(std::move(made)) {}
    void all_reduce_sum(std::vector<at::Tensor>& values) override { backend->allreduce(values)->wait(); }
    void broadcast(std::vector<at::Tensor>& values) override { backend->broadcast(values)->wait(); }
    c10::intrusive_ptr<Backend> backend;
};

#ifdef ACTFORMER_GLOO
std::unique_ptr<Collective> gloo(const c10::intrusive_ptr<c10d::Store>& store, const Place& place) {
    auto options = c10d::ProcessGroupGloo::Options::create();
    if (const auto interface = environment("GLOO_SOCKET_IFNAME"))
        options->devices.push_back(c10d::ProcessGroupGloo::createDeviceForInterface(*interface));
    else if (place.address == "127.0.0.1" || place.address == "localhost")
        options->devices.push_back(c10d::ProcessGroupGloo::createDeviceForHostname("127.0.0.1"));
    else
        options->devices.push_back(c10d::ProcessGroupGloo::createDefaultDevice());
    using Group = c10d::ProcessGroupGloo;
    return std::make_unique<Through<Group>>(
        c10::make_intrusive<Group>(store, place.rank, place.size, options));
}
#endif

std::unique_ptr<Collective> collective_on(const at::Device& device,
                                          const c10::intrusive_ptr<c10d::Store>& store, const Place& place) {
    if (device.is_cuda()) {
#ifdef ACTFORMER_NCCL
        using Group = c10d::ProcessGroupNCCL;
        return std::make_unique<Through<Group>>(c10::make_intrusive<Group>(store, place.rank, place.size));
#endif
    } else {
#ifdef ACTFORMER_GLOO
        return gloo(store, place);
#endif
    }
    throw Error("--data-parallel: this build has no {}; build with a libtorch and headers that have it",
                device.is_cuda() ? "NCCL for GPUs" : "Gloo for processors (Debian: libgloo-dev)");
}

/// Versions that know libuv want it unless told otherwise, and Debian builds them without.
template <typename Options>
void without_libuv(Options& options) {
    if constexpr (requires { options.useLibUV; }) options.useLibUV = false;
}

/// Gloo's and NCCL's errors have no class in common, and say where in their sources they were thrown.
template <typename Act>
void with_peers(const Place& place, const Act& act) {
    try {
        act();
    } catch (const std::exception&) {
        throw PeerLost("rank {} of {}: another process has ended or cannot be reached; that one says why",
                       place.rank, place.size);
    }
}

}  // namespace

struct Processes::Group {
    c10::intrusive_ptr<c10d::Store> tcp, store;
    std::unique_ptr<Collective> work;
};

Processes::Processes(Place place, const at::Device& device)
    : place_(std::move(place)), group_(std::make_unique<Group>()) {
    c10d::TCPStoreOptions options;
    options.port = place_.port;
    options.isServer = place_.leads() && !place_.store_runs;
    if (!place_.store_runs) options.numWorkers = place_.size;
    options.timeout = std::chrono::minutes(5);
    without_libuv(options);
    try {
        group_->tcp = c10::make_intrusive<c10d::TCPStore>(place_.address, options);
        group_->store = c10::make_intrusive<c10d::PrefixStore>(place_.prefix, group_->tcp);
        group_->work = collective_on(device, group_->store, place_);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {  // of sockets and of Gloo too, which have classes of their own
        throw Error("rank {} of {}: no meeting at {}:{}: {}", place_.rank, place_.size, place_.address,
                    place_.port, one_line(e));
    }
}

void Processes::all_reduce_mean(at::Tensor values) const {
    if (!group_) return;
    const at::NoGradGuard no_gradients;
    std::vector<at::Tensor> one{values};
    with_peers(place_, [&] { group_->work->all_reduce_sum(one); });
    values.div_(place_.size);
}

void Processes::broadcast(at::Tensor values) const {
    if (!group_) return;
    std::vector<at::Tensor> one{values};
    with_peers(place_, [&] { group_->work->broadcast(one); });
}

#else

struct Processes::Group {};

Processes::Processes(Place, const at::Device&) {
    throw Error("--data-parallel: this libtorch was built without c10d, its process groups");
}

void Processes::all_reduce_mean(at::Tensor) const {}

void Processes::broadcast(at::Tensor) const {}

#endif

Processes::Processes() = default;
Processes::~Processes() = default;

}  // namespace actformer::model
