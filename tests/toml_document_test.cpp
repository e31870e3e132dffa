// TOML with typed access: every error has its place, unknown keys name the nearest known one, overrides name themselves.
#include <gtest/gtest.h>

#include "tenon/problems/toml/document.hpp"
#include "tenon/tests/expect_message.hpp"

namespace tenon::toml_file {
namespace {

constexpr const char* kText = R"(name = "a"
mass = 2
list = [1, 2.5]
[limits]
hard = true
[[rotor]]
spin = 1
[[rotor]]
spin = -1
)";

const std::vector<std::string> kKeys{"name", "mass", "list", "limits", "rotor"};

Table root(const std::vector<std::string>& overrides = {}) {
  return Document(kText, "v.toml", overrides).root(kKeys);
}

TEST(TomlDocument, ReadsWhatIsThere) {
  const Table table = root();
  EXPECT_EQ(table.text("name"), "a");
  EXPECT_EQ(table.number("mass"), 2);
  EXPECT_EQ(table.number("other", 7), 7);
  EXPECT_EQ(table.numbers("list"), (std::vector<double>{1, 2.5}));
  EXPECT_TRUE(table.table("limits", {"hard"})->flag("hard"));
  ASSERT_EQ(table.tables("rotor", {"spin"}).size(), 2u);
  EXPECT_EQ(table.tables("rotor", {"spin"})[1].integer("spin"), -1);
  EXPECT_FALSE(table.table("none"));
}

TEST(TomlDocument, SaysWhatIsWrongAndWhere) {
  EXPECT_MESSAGE(Document("a = ", "v.toml"), InputError, "v.toml:1:");
  EXPECT_MESSAGE(root().text("mass"), InputError, "v.toml:2:8: 'mass' is the integer 2 (expected text in quotes)");
  EXPECT_MESSAGE(root().numbers("list", 3), InputError, "v.toml:3:8: 'list' has 2 entries (expected a list of 3 numbers)");
  EXPECT_MESSAGE(root().number("weight"), InputError, "key 'weight' is missing");
  EXPECT_MESSAGE(Document("mass = nan", "v.toml").root({"mass"}).number("mass"), InputError, "v.toml:1:8: 'mass' is the number nan");
  EXPECT_MESSAGE(Document("mass = inf", "v.toml").root({"mass"}).number("mass"), InputError, "leave the key out for no limit");
}

TEST(TomlDocument, AnUnknownKeyNamesTheNearestKnownOne) {
  EXPECT_MESSAGE(Document("mas = 1", "v.toml").root(kKeys), InputError, "v.toml:1:1: unknown key 'mas'; the nearest known key is 'mass'");
  EXPECT_MESSAGE(root().tables("rotor", {"spine"}), InputError,
                 "v.toml:7:1: unknown key 'spin' in rotor.1; the nearest known key is 'spine'");
}

TEST(TomlDocument, OverridesValuesAndCountsFromOne) {
  EXPECT_EQ(root({"mass=3"}).number("mass"), 3);
  EXPECT_EQ(root({"rotor.2.spin=1"}).tables("rotor", {"spin"})[1].integer("spin"), 1);
  EXPECT_EQ(root({"list.2=9"}).numbers("list"), (std::vector<double>{1, 9}));
  EXPECT_EQ(root({"list=[4]"}).numbers("list"), (std::vector<double>{4}));
  EXPECT_EQ(root({"name=ipopt"}).text("name"), "ipopt");
  EXPECT_FALSE(root({"limits.hard=false"}).table("limits", {"hard"})->flag("hard"));
}

TEST(TomlDocument, AnErrorInAnOverrideNamesTheOverride) {
  EXPECT_MESSAGE(root({"mas=3"}), InputError, "--set mas=3: unknown key 'mas'");
  EXPECT_MESSAGE(root({"limit.hard=true"}), InputError, "--set limit.hard=true: unknown key 'limit'");
  EXPECT_MESSAGE(root({"rotor.2.spin=x"}).tables("rotor", {"spin"})[1].integer("spin"), InputError, "--set rotor.2.spin=x: ");
  EXPECT_MESSAGE(root({"rotor.3.spin=1"}), InputError, "there is no element '3' (expected a number from 1 to 2)");
  EXPECT_MESSAGE(root({"mass"}), InputError, "--set mass: is no assignment");
  EXPECT_MESSAGE(root({"mass=[1"}), InputError, "is no TOML value");
  EXPECT_MESSAGE(root({"mass.x=1"}), InputError, "is a single value");
}

}  // namespace
}  // namespace tenon::toml_file
