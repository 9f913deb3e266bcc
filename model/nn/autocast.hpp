// Matrix products and convolutions in bfloat16 on CUDA, as far as a scope reaches. Includes torch headers.
#pragma once

#include <ATen/autocast_mode.h>
#include <c10/core/DispatchKeySet.h>
#include <c10/core/impl/LocalDispatchKeySet.h>
#include <torch/version.h>

namespace actformer::model {

class Autocast {
  public:
    explicit Autocast(bool on) : on_(on) {
        if (on_) set(true);
    }
    ~Autocast() {
        if (!on_) return;
        set(false);
        at::autocast::clear_cache();
    }
    Autocast(const Autocast&) = delete;
    Autocast& operator=(const Autocast&) = delete;

  private:
    static void set(bool on) {
#if TORCH_VERSION_MAJOR > 2 || (TORCH_VERSION_MAJOR == 2 && TORCH_VERSION_MINOR >= 4)
        at::autocast::set_autocast_dtype(at::kCUDA, at::kBFloat16);
        at::autocast::set_autocast_enabled(at::kCUDA, on);
#else
        at::autocast::set_autocast_gpu_dtype(at::kBFloat16);
        at::autocast::set_enabled(on);
#endif
    }
    bool on_;
};

/// Within an Autocast: operators keep their arguments' types, as far as the scope reaches.
class NoAutocast {
  private:
    c10::impl::ExcludeDispatchKeyGuard guard_{c10::autocast_dispatch_keyset};
};

}  // namespace actformer::model
