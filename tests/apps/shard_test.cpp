// Parts of a run: how they are named, and that together they are the whole. Oracle: the documented
// contract.
#include "apps/study/shard.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/study/part_file.h"
#include "ar/error.h"
#include "tests/ar/temporary_folder.h"

namespace gnomon::apps::study {
namespace {

using testing::HasSubstr;

std::string message_of(const std::function<void()>& run) {
  try {
    run();
  } catch (const ar::InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(Shard, EveryJobIsInExactlyOne) {
  for (const std::size_t count : {1, 2, 3, 7, 16}) {
    std::vector<int> seen(100, 0);
    for (std::size_t number = 1; number <= count; ++number)
      for (std::size_t job = 0; job < seen.size(); ++job)
        seen[job] += Shard{number, count}.has(job);
    EXPECT_THAT(seen, testing::Each(1)) << count;
  }
}

TEST(Shard, TextThatIsNoneIsRefusedWithTheOption) {
  EXPECT_EQ(parse_shard("--shard", "2/8"), (Shard{2, 8}));
  for (const char* text :
       {"", "1", "/", "1/", "/2", "0/2", "3/2", "1/0", "-1/2", "1/2x", " 1/2", "1/100001", "a/b"})
    EXPECT_THAT(message_of([&] { parse_shard("--shard", text); }), HasSubstr("--shard: '")) << text;
}

TEST(PartFile, PartsAreFoundInOrderAndMissedByNumber) {
  const ar::TemporaryFolder folder;
  const auto touch = [&](std::size_t number, std::size_t count) {
    std::ofstream(part_file(folder.path(), "chart", {number, count})) << "{}";
  };
  EXPECT_THAT(message_of([&] { find_parts(folder.path(), "chart"); }),
              HasSubstr("no chart-I-of-N"));
  touch(1, 1);
  for (const std::size_t number : {3, 1}) touch(number, 3);
  EXPECT_THAT(message_of([&] { find_parts(folder.path(), "chart"); }),
              HasSubstr("part 2 of 3 is missing"));
  touch(2, 3);
  const auto parts = find_parts(folder.path(), "chart");
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[1].filename(), "chart-2-of-3.json");
  touch(1, 2);
  EXPECT_THAT(message_of([&] { find_parts(folder.path(), "chart"); }), HasSubstr("parts of "));
}

TEST(PartFile, EveryJobIsWantedOnce) {
  const auto message = [](std::size_t jobs, const std::vector<std::size_t>& done) {
    return message_of([&] { require_every_job(jobs, done); });
  };
  EXPECT_EQ(message(3, {0, 1, 2}), "nothing was thrown");
  EXPECT_THAT(message(3, {0, 2}), HasSubstr("job 1 is missing"));
  EXPECT_THAT(message(3, {0, 1}), HasSubstr("job 2 is missing"));
  EXPECT_THAT(message(3, {0, 1, 1, 2}), HasSubstr("job 1 is there twice"));
  EXPECT_THAT(message(3, {0, 1, 2, 3}), HasSubstr("there is no job 3"));
}

TEST(PartFile, NamesThatLeaveTheFolderAreNotPlain) {
  for (const char* name : {"", ".", "..", ".x", "a/b", "../a", "a b", "a\n", "\xc3\xa4"})
    EXPECT_FALSE(is_plain_name(name)) << name;
  EXPECT_TRUE(is_plain_name("01_map_1024.png"));
  EXPECT_EQ(plain_name("map 512, 2x2/filter"), "map_512__2x2_filter");
  EXPECT_TRUE(is_plain_name(plain_name("../..")));
}

}  // namespace
}  // namespace gnomon::apps::study
