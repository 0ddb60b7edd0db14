#include "api/job_view.h"
#include "clients/cli/remote_commands.h"
#include "clients/cli/user_error.h"
#include "tests/clients/cli/small_service.h"
#include "tests/support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using testing::HasSubstr;
using testing::Not;

// What `run` says when it is interrupted and its service answers the cancelling with `status`.
std::string said_when_canceling_is_answered(int status, const std::string& body)
{
    std::stop_source stop;
    api::JobView running;
    running.id = std::string(32, 'a');
    running.state = api::JobState::running;
    const tests::SmallService service([&](const httplib::Request& request, httplib::Response& response) {
        const bool cancels = request.path.ends_with("/cancel");
        if (request.method == "GET") stop.request_stop();
        response.status = cancels ? status : 202;
        response.set_content(cancels ? body : api::write_job_view(running), "application/json");
    });
    const tests::TempFolder folder;
    clients::RunOptions options;
    options.submit.scene = folder.write("scene.json", R"({"scene":{"objects":[{"shape":"sphere"}]}})");
    options.output = folder.file("out.png");
    testing::internal::CaptureStderr();
    try {
        clients::run_command(
            {.url = service.url().origin, .patience_s = 5, .quiet = true}, options, stop.get_token());
        ADD_FAILURE() << "it was not interrupted";
    } catch (const clients::UserError& error) {
        EXPECT_EQ(error.code(), clients::ExitCode::interrupted);
    }
    return testing::internal::GetCapturedStderr();
}

TEST(RunCommand, SaysThatItsJobWasCancelledOnlyWhereItWas)
{
    EXPECT_THAT(said_when_canceling_is_answered(200, "{}"), HasSubstr("was cancelled"));
    EXPECT_THAT(said_when_canceling_is_answered(202, "{}"), HasSubstr("was cancelled"));
    const std::string refused = said_when_canceling_is_answered(
        503, R"({"code":"storage_full","detail":"the disk is full","status":503})");
    EXPECT_THAT(refused, HasSubstr("could not be cancelled"));
    EXPECT_THAT(refused, HasSubstr("the disk is full"));
    EXPECT_THAT(refused, Not(HasSubstr("was cancelled")));
}

} // namespace
