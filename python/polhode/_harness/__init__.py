"""What measurements stand on: processes that may crash, what is true of a scene, and the machine."""
