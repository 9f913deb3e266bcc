// How long a sweep's jobs may take, from those that are done.
#include <gtest/gtest.h>

#include "reports/sweep/results.hpp"

using namespace actformer::reports;

namespace {

struct JobTimes : ::testing::Test {
    /// A training that took so many seconds, or, of 0, is to be done; work of 0 is not known.
    std::size_t training(const std::string& config, double work, double seconds) {
        Job job;
        job.kind = "generator";
        job.work = TrainingWork{"generator", config, "data", {}};
        job.amount = work;
        plan.jobs.push_back(job);
        JobStatus status;
        if (seconds > 0) status = {JobState::done, "", seconds};
        statuses.push_back(status);
        return plan.jobs.size() - 1;
    }
    double of(std::size_t job) const { return estimate(plan, statuses, job).value_or(-1); }

    Plan plan;
    std::vector<JobStatus> statuses;
};

}  // namespace

TEST_F(JobTimes, ComesFromTrainingsOfTheSameConfiguration) {
    training("actor.yaml", 100, 400);
    training("csgn.yaml", 100, 50);
    EXPECT_DOUBLE_EQ(of(training("actor.yaml", 50, 0)), 200);
    EXPECT_DOUBLE_EQ(of(training("actformer.yaml", 40, 0)), 90) << "none of it is done: all of its kind tell";
}

TEST_F(JobTimes, WorkThatIsNotKnownDoesNotMakeTheRestSlow) {
    for (int i = 0; i < 20; ++i) training("actor.yaml", 0, 300);
    training("actor.yaml", 100, 400);
    EXPECT_DOUBLE_EQ(of(training("actor.yaml", 100, 0)), 400);
    EXPECT_DOUBLE_EQ(of(training("actor.yaml", 0, 0)), (20 * 300 + 400) / 21.0)
        << "each as long as they took";
}

TEST_F(JobTimes, IsARoughRateOrNothingWhereNothingIsDone) {
    const auto unknown = training("actor.yaml", 0, 0), known = training("actor.yaml", 100, 0);
    plan.jobs[known].pace = 10;
    EXPECT_EQ(of(unknown), -1);
    EXPECT_DOUBLE_EQ(of(known), 2 + 100 / 10.0);
}
