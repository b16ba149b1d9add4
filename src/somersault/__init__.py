"""Bodies in the air: will this maneuver come out right by itself?"""
