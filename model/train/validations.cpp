#include "model/train/validations.hpp"

#include "base/text/json.hpp"

namespace actformer::model {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const ValidationReport& report) {
    return {{"epoch", report.epoch}, {"step", report.step}, {"values", report.values}};
}

ValidationReport report_from(const Json& json) {
    ValidationReport report;
    report.epoch = whole_number<std::uint64_t>(json.at("epoch"));
    report.step = whole_number<std::uint64_t>(json.at("step"));
    report.values = json.at("values");
    return report;
}

/// Checkpoints of before say the recogniser alone, which a fingerprint begins with.
bool is_fingerprint_of(const Validator& validator, const std::string& kept) {
    const auto now = validator.fingerprint();
    return kept == now || now.starts_with(kept + ",");
}

}  // namespace

void Validations::add_to(Json& state) const {
    if (best_) {
        state["scorer"] = best_scorer_;
        state["best"] = json_of(*best_);
        state["best"]["merit"] = best_selection_score_;
    }
    if (last_) state["last"] = json_of(*last_);
}

bool Validations::take_from(const Json& state, bool goes_on) {
    if (!state.contains("best")) return true;
    if (validator_ && goes_on && !is_fingerprint_of(*validator_, state.at("scorer"))) return false;
    best_ = report_from(state.at("best"));
    best_->best = true;
    best_scorer_ = state.at("scorer");
    best_selection_score_ = state.at("best").at("merit");
    if (state.contains("last")) last_ = report_from(state.at("last"));
    return true;
}

std::optional<ValidationReport> Validations::end() {
    auto validation = validator_ ? validator_->end() : std::nullopt;
    if (!validation) return std::nullopt;
    auto& report = validation->report;
    report.best = !best_ || validation->selection_score > best_selection_score_;
    last_ = report;
    if (report.best) {
        best_ = report;
        best_scorer_ = validator_->fingerprint();
        best_selection_score_ = validation->selection_score;
        unsaved_best_ = std::move(validation->weights);
    }
    return report;
}

void Validations::save_best(
    const std::function<void(const std::vector<Array>& weights, std::uint64_t step)>& save) {
    if (!unsaved_best_) return;
    save(*unsaved_best_, best_->step);
    unsaved_best_.reset();
}

}  // namespace actformer::model
