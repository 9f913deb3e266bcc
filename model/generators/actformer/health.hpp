// Whether a game of two networks can still be won: watched on the mean losses of some steps at a time.
#pragma once

#include <cstdint>
#include <string>

#include "model/generators/actformer/gan_settings.hpp"

namespace actformer::model {

struct Losses {
    double discriminator = 0, real_score = 0, made_score = 0, generator = 0;
};

class Health {
  public:
    explicit Health(Loss loss) : loss_(loss) {}

    /// Takes the means over the last `steps` steps.
    void see(const Losses& losses, std::uint64_t steps);

    /// Nothing is wrong: what there is now is worth keeping.
    bool sound() const { return trouble_.empty(); }

    /// What is beyond hope, in words; empty while there is some. Numbers that are none are at once; a collapse is after
    /// `patience` steps without a sign of life.
    std::string verdict() const;

    static constexpr std::uint64_t patience = 200;

  private:
    Loss loss_;
    std::string trouble_;
    std::uint64_t steps_ = 0;  ///< in trouble
    bool at_once_ = false;
};

}  // namespace actformer::model
