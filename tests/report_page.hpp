// A report page opened in a real browser; a test is skipped where there is none.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tenon/apps/report/report.hpp"
#include "tenon/tests/browser.hpp"

namespace tenon {

inline constexpr const char* kReady = "document.documentElement?.dataset.ready === 'true'";
inline constexpr const char* kAnimated = "window.report?.parts[0].animation?.camera";

class ReportPage : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!browser_path().empty()) browser_ = new Browser();
  }
  static void TearDownTestSuite() {
    delete browser_;
    browser_ = nullptr;
  }
  void SetUp() override {
    if (browser_ == nullptr) GTEST_SKIP() << "there is no chromium (Debian's package chromium) to open the page with";
  }

  Browser& browser() { return *browser_; }

  void open(const std::vector<std::string>& files, const std::string& hash = "", const char* condition = kReady, int width = 1280) {
    const std::string page = folder_.path("page.html");
    write_report(files, page);
    browser().open(page + hash, condition, width);
  }

  void expect_silence() {
    EXPECT_EQ(browser().complaints(), std::vector<std::string>());
    for (std::size_t k = 1; k < browser().requests().size(); ++k) {
      const std::string& address = browser().requests()[k];
      EXPECT_TRUE(address.starts_with("data:") || address.starts_with("blob:")) << address;
    }
  }

  ScratchFolder folder_;

 private:
  static inline Browser* browser_ = nullptr;
};

}  // namespace tenon
