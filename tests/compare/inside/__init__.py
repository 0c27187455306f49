"""What runs inside Blender: preparing a scene so that two engines must render the same picture."""
