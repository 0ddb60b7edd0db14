#include "clients/cli/files.h"
#include "clients/cli/sky_commands.h"
#include "clients/cli/user_error.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <string>

using namespace clients;

namespace {

class SkyCommands : public testing::Test {
protected:
    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
    SkyTableOptions questions(const std::string& atmosphere, const std::string& rows) const
    {
        write_file(file("air.json"), atmosphere);
        write_file(file("in.csv"), rows);
        return {file("air.json"), file("in.csv"), file("out.csv"), 1};
    }
    std::string answers() const { return read_file(file("out.csv")); }
    // What is told of a run that fails, without the folder.
    std::string error_of(const SkyTableOptions& options) const
    {
        try {
            sky_probe_command(options, {});
        } catch (const UserError& error) {
            const std::string text = error.what();
            return text.substr(text.rfind('/', text.find(": ")) + 1);
        }
        return "none";
    }

private:
    tests::TempFolder folder_;
};

constexpr const char* kSingle = R"({"type": "atmosphere", "preset": "reference_s", "scattering": "single"})";

} // namespace

TEST_F(SkyCommands, AnswerRowsOfSeveralAtmospheres)
{
    const auto options = questions(kSingle,
                                   "atm,lambda_nm,altitude_m,sun_zenith_deg,view_zenith_deg,az_deg,mark\n"
                                   "R,680,0,0,0,0,one\n"
                                   "S,680,0,0,0,0,two\n"
                                   ",680,0,0,0,0,three\n");
    EXPECT_EQ(sky_probe_command(options, {}), ExitCode::ok);
    const std::string text = answers();
    EXPECT_NE(text.find("az_deg,mark,L_over_E0,single,total\n"), std::string::npos) << text;
    EXPECT_NE(text.find("one,0.00528671622"), std::string::npos) << text; // reference_r's
    const auto tail = [&](const char* mark) {
        const auto at = text.find(mark) + std::string(mark).size();
        return text.substr(at, text.find('\n', at) - at);
    };
    EXPECT_EQ(tail("two"), tail("three"));
}

TEST_F(SkyCommands, SeeTheLimbAndTheNadir)
{
    const auto options = questions(kSingle,
                                   "lambda_nm,altitude_m,tangent_height_m,sun_zenith_deg,az_deg\n"
                                   "680,100000,5000,90,0\n"
                                   "680,100000,-1,90,0\n"
                                   "680,100000,61000,30,0\n");
    EXPECT_EQ(sky_probe_command(options, {}), ExitCode::ok);
    EXPECT_NE(answers().find(",0.12988948"), std::string::npos) << answers();
    EXPECT_NE(answers().find(",0.0012307"), std::string::npos) << answers();
    EXPECT_NE(answers().find("61000,30,0,0,0,0\n"), std::string::npos) << answers();
}

TEST_F(SkyCommands, TakeOtherWavelengthsByThePresetsLaws)
{
    const std::string rows = "lambda_nm,altitude_m,zenith_deg\n500,0,0\n680,0,100\n";
    EXPECT_EQ(sky_transmittance_command(questions(kSingle, rows), {}), ExitCode::ok);
    EXPECT_NE(answers().find("680,0,100,inf,0\n"), std::string::npos) << answers();
    const std::string fixed =
        R"({"type": "atmosphere", "scattering": "single", "rayleigh": {"scattering": [1e-6, 2e-6, 3e-6]}})";
    EXPECT_THROW(sky_transmittance_command(questions(fixed, rows), {}), UserError);
}

TEST_F(SkyCommands, NameTheLineOfARowThatIsWrong)
{
    const std::string head = "lambda_nm,altitude_m,sun_zenith_deg,view_zenith_deg,az_deg\n680,0,0,0,0\n";
    EXPECT_EQ(error_of(questions(kSingle, head + "680,0,x,0,0\n")),
              "in.csv:3: sun_zenith_deg: \"x\" is not a number");
    EXPECT_EQ(error_of(questions(kSingle, head + "680,0,0,181,0\n")),
              "in.csv:3: view_zenith_deg: not in [0, 180]");
    EXPECT_EQ(error_of(questions(kSingle, "altitude_m\n0\n")),
              "in.csv: there is no column lambda_nm; there are: altitude_m");
    EXPECT_NE(error_of(questions(R"({"type": "atmosphere", "mie": {"g": 1}})", head)).find("/mie/g"),
              std::string::npos);
}

TEST_F(SkyCommands, PaintAPanorama)
{
    write_file(file("air.json"), kSingle);
    EXPECT_EQ(sky_panorama_command({file("air.json"), file("sky.pfm"), 16, 8, 0, 1}, {}), ExitCode::ok);
    EXPECT_EQ(read_file(file("sky.pfm")).size(), std::string("PF\n16 8\n-1.0\n").size() + 16 * 8 * 12);
    EXPECT_THROW(sky_panorama_command({file("air.json"), file("sky.gif"), 16, 8, 0, 1}, {}), UserError);
}
