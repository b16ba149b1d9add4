"""Chapter 2 of Playter (1994)."""
