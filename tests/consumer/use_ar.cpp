// A stranger's program: a function of each layer, linked with all that they need.
#include <filesystem>
#include <iostream>

#include <ar/error.h>
#include <ar/image_file.h>

int main() {
  try {
    gnomon::ar::read_image("no_such_picture.png");
  } catch (const gnomon::ar::InputError& error) {
    std::cout << error.what() << '\n';
    return 0;
  }
  return 1;
}
