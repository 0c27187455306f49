"""What runs inside Blender: making the bench's scenes, and rendering them against the clock."""
