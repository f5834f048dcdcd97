// A stranger's program: the augmented reality library links with all that it needs.
#include <iostream>

#include <ar/error.h>

int main() {
  const gnomon::ar::InputError error("photo.png: cannot be read");
  std::cout << error.what() << '\n';
}
