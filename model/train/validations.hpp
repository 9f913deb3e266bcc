// The validations of a training: its best and last scores, and the best one's weights until they are written. Includes torch headers.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "model/train/training_events.hpp"
#include "model/train/validator.hpp"

namespace actformer::model {

class Validations {
  public:
    /// `validator` may be null: nothing is scored then. It outlives these.
    explicit Validations(Validator* validator) : validator_(validator) {}

    /// What a checkpoint's state keeps.
    void add_to(nlohmann::ordered_json& state) const;

    /// Takes it back, without a validator too: the folder's best weights are still those. False where the training goes on with another
    /// validator, whose scores are not to be compared with those so far.
    bool take_from(const nlohmann::ordered_json& state, bool goes_on);

    bool scores() const { return validator_ != nullptr; }
    bool due(std::uint64_t epoch, bool last) const { return validator_ && validator_->due(epoch, last); }
    bool in_background() const { return validator_ && validator_->in_background(); }
    void begin(std::uint64_t epoch, std::uint64_t step) { validator_->begin(epoch, step); }

    /// Waits for the scores on their way; none where there are none.
    std::optional<ValidationReport> end();

    /// Calls `save` with the best weights and their step, unless it has succeeded with them before.
    void save_best(const std::function<void(const std::vector<Array>& weights, std::uint64_t step)>& save);

    const std::optional<ValidationReport>& best() const { return best_; }
    const std::optional<ValidationReport>& last() const { return last_; }

  private:
    Validator* validator_;
    std::optional<ValidationReport> best_, last_;
    std::optional<std::vector<Array>> unsaved_best_;
    std::string best_scorer_;  ///< fingerprint of the validator that chose the best
    double best_selection_score_ = 0;
};

}  // namespace actformer::model
